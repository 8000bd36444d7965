"""What is wrong with a file of another code."""


class FileError(ValueError):
    """A file cannot be read as it stands.

    file  its path
    line  the line at fault, from 1; 0: the file as a whole, or a binary one, where the text has the byte
    text  what was found and what to do

        try:
            deck = plm.fe.read_deck("absent.inp")
        except plm.fe.FileError as error:
            print(error.file, error.line, error.text)
    """

    def __init__(self, file, line, text):
        self.file, self.line, self.text = str(file), int(line), str(text)
        super().__init__(f"{self.file}:{self.line}: {self.text}" if self.line else f"{self.file}: {self.text}")
