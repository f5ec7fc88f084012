from ._scan import Scan, scan
from ._service_fit import ServiceDay, fit_service
from ._watch import Watch, watch_folders

__all__ = ["Scan", "ServiceDay", "Watch", "fit_service", "scan", "watch_folders"]
