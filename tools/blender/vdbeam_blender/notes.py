"""What the export leaves out, for the info log."""

# Why an image has no file (images.file_of).
NO_IMAGE = "since it is not a single image, or its file is missing"


class Notes:
    """Lines for the user in the order in which they came, each once."""

    def __init__(self):
        self.lines = []

    def add(self, subject, text):
        """Notes that `text` applies to `subject`, an object or material."""
        line = f"{subject}: {text}"
        if line not in self.lines:
            self.lines.append(line)
