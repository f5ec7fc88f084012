"""The actions of ``shaftprint fleet``, one file each."""
