from ._scan import Scan, scan
from ._service_fit import fit_service
from ._watch import watch_folders

__all__ = ["Scan", "fit_service", "scan", "watch_folders"]
