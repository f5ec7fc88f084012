"""The pages: each file gives what one of them says, to browsers and programs alike."""

from shaftprint.web.pages._audit import audit
from shaftprint.web.pages._classes import sister_class
from shaftprint.web.pages._compare import compare
from shaftprint.web.pages._folders import folder
from shaftprint.web.pages._jobs import job, job_events, jobs, new_job, retry_job
from shaftprint.web.pages._line import line, new_event, withdraw
from shaftprint.web.pages._number import give_number
from shaftprint.web.pages._recordings import (
    CAMPAIGNS,
    STRUCTURES,
    VESSELS,
    is_imo_number,
    look,
    put_recording,
    recording,
    upload,
    upload_form,
)
from shaftprint.web.pages._reports import make_report, report_file
from shaftprint.web.pages._ships import ships
from shaftprint.web.pages._sign_in import session, sign_in, sign_in_form, sign_out
from shaftprint.web.pages._static import static
from shaftprint.web.pages._trial import fingerprint_document, trial

__all__ = [
    "CAMPAIGNS",
    "STRUCTURES",
    "VESSELS",
    "audit",
    "compare",
    "fingerprint_document",
    "folder",
    "give_number",
    "is_imo_number",
    "job",
    "job_events",
    "jobs",
    "line",
    "look",
    "make_report",
    "new_event",
    "new_job",
    "put_recording",
    "recording",
    "report_file",
    "retry_job",
    "session",
    "ships",
    "sign_in",
    "sign_in_form",
    "sign_out",
    "sister_class",
    "static",
    "trial",
    "upload",
    "upload_form",
    "withdraw",
]
