"""The actions of ``shaftprint service``, one file each."""
