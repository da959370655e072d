"""A folder of its own for each test, and made-up files in it."""

from in_folder import InFolder

from . import synthetic
from .registry import MACHINES


class Scratch(InFolder):
    def written(self, name):
        """Experiments from made-up files, and what the maker of these returns."""
        reader = MACHINES[name].reader
        data = self.folder / "data" / reader.FOLDER
        truth = getattr(synthetic, name)(data)
        for file in reader.FILES:
            self.assertTrue((data / file).is_file(), file)
        return reader.write(data, self.folder / name), truth
