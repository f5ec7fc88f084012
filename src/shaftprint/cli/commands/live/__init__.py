"""The actions of ``shaftprint live``, one file each."""
