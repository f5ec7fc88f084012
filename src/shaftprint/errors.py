"""What can go wrong, one class a room.

::

    ShaftprintError
    ├── SettingsError         a vessel or campaign file that cannot be used
    ├── RecordingError        a logger file that cannot be read
    ├── SignalError           a channel that does not give a usable signal
    │   └── ForeignCampaignError  a recording that shows the set point of another campaign
    ├── ClockError            two recordings whose clocks cannot be brought together
    ├── ResponseError         a test line or response that cannot be estimated
    ├── PropellerError        a propeller or speed for which no curve was measured
    ├── StructureError        a model structure or parameter that makes no sense
    │   └── ExactStepsError   a structure or an input whose jumps cannot all be followed
    ├── IdentificationError   a fit that cannot be set up or has no acceptable result
    ├── DesignError           a test that cannot be planned within its limits
    ├── ValidationError       a model that cannot be held against a record
    ├── ServiceError          logs of ordinary service that cannot be used, or show nothing
    ├── FingerprintError      a fingerprint file that cannot be read or compared
    │   └── NoSuchNumberError a name that is none of its numbers; a KeyError too
    ├── PublicationError      a folder into which results cannot be put, or not as a whole
    ├── ReportError           a report that cannot be written
    ├── StoreError            a store of fingerprints that cannot be used, or a record that it refuses
    │   └── DatabaseError     a database that is busy, full, damaged or not reached: another time it may do
    ├── ServerError           a server that cannot be started, or a request that it refuses
    ├── LiveError             a live test that cannot be armed, or whose counterpart refuses
    │   └── SilentLinkError   a counterpart of which nothing comes any more
    ├── ExportError           a model that cannot be written for another program
    └── RequestError          arguments that do not go together, or of which one is missing

Every message says which file, channel, second or field, what was expected, what was found and what to do.
"""

from typing import ClassVar


class ShaftprintError(Exception):
    """Base of all errors that a user can mend."""


class SettingsError(ShaftprintError):
    """A vessel or campaign file cannot be used."""


class RecordingError(ShaftprintError):
    """A logger file cannot be read."""


class SignalError(ShaftprintError):
    """A channel does not give a usable signal."""


class ForeignCampaignError(SignalError):
    """A recording shows the set point of another campaign."""

    REMEDY: ClassVar[str] = (
        "; name the campaign file that belongs to it, or make one of the recording with `shaftprint new campaign FILE "
        "--from RECORDING`."
    )
    """What it ends with, where nobody knows which campaign it is."""


class ClockError(ShaftprintError):
    """The clocks of two recordings cannot be brought together."""


class ResponseError(ShaftprintError):
    """A test line or a frequency response cannot be estimated."""


class PropellerError(ShaftprintError):
    """A propeller or a working point lies outside of what was measured."""


class StructureError(ShaftprintError):
    """A model structure or one of its parameters makes no sense."""


class ExactStepsError(StructureError):
    """The jumps of an input cannot all be followed through a structure; approximate steps can."""


class IdentificationError(ShaftprintError):
    """A fit cannot be set up or has no acceptable result."""


class DesignError(ShaftprintError):
    """A test cannot be planned within its limits."""


class ValidationError(ShaftprintError):
    """A model cannot be held against a record."""


class ServiceError(ShaftprintError):
    """Logs of ordinary service cannot be used, or show nothing of the line."""


class FingerprintError(ShaftprintError):
    """A fingerprint file cannot be read or compared."""


class NoSuchNumberError(FingerprintError, KeyError):
    """A name that none of the numbers of a fingerprint has."""

    def __str__(self) -> str:
        """Return the sentence, where a KeyError would show it as a text in quotes."""
        return Exception.__str__(self)


class PublicationError(ShaftprintError):
    """Results cannot be put into a folder, or not as a whole."""


class ReportError(ShaftprintError):
    """A report cannot be written."""


class StoreError(ShaftprintError):
    """A store of fingerprints cannot be used, or a record cannot be kept in it."""


class ServerError(ShaftprintError):
    """A server of pages cannot be started, or refuses what was asked of it."""


class DatabaseError(StoreError):
    """The database of a store is busy, full, damaged or not reached; nothing is wrong with the record."""


class ExportError(ShaftprintError):
    """A model cannot be written for another program."""


class LiveError(ShaftprintError):
    """A live test cannot be armed, or its counterpart refuses what was asked of it."""


class SilentLinkError(LiveError):
    """Nothing comes from a counterpart any more; whoever waits longer waits for ever."""


class RequestError(ShaftprintError):
    """What was asked for does not go together or is not complete; the program says how it is called."""
