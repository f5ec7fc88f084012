from ._scan import Scan, scan
from ._service_fit import ServiceDay, fit_service

__all__ = ["Scan", "ServiceDay", "fit_service", "scan"]
