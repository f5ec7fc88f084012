"""The actions of ``shaftprint store``, one file each."""
