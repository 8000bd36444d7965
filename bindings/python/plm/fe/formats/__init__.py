"""The formats, one module each: what marks a file of it, how it is read, how it is written."""
