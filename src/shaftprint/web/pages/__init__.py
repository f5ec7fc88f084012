"""The pages: each file gives what one of them says, to browsers and programs alike."""
