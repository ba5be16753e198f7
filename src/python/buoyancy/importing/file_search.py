"""Finds the files that a model names: model://, package://, file:// and relative names."""
import os
import urllib.parse
from pathlib import Path

from .failure import fail

_VARIABLES = ("GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "SDF_PATH", "ROS_PACKAGE_PATH")
_MAX_PARENTS = 8


class FileSearch:
    """Searches the model's folder, its parents, --path, and the folders of the variables of Gazebo and ROS."""

    def __init__(self, model_file, paths):
        folder = Path(model_file).resolve().parent
        self.folders = [folder, *list(folder.parents)[:_MAX_PARENTS], *map(Path, paths)]
        for variable in _VARIABLES:
            self.folders += [Path(name) for name in os.environ.get(variable, "").split(os.pathsep) if name]

    def find(self, uri, element, kind="file"):
        """The path of `uri`, which `element` names; a file or a folder."""
        scheme, separator, rest = uri.strip().partition("://")
        name = urllib.parse.unquote(rest if separator else uri.strip())
        near = Path(element.file).resolve().parent
        if not separator and name.startswith("file:"):
            scheme, name = "file", name[len("file:") :]
        if scheme == "file" and os.path.isabs(name):
            candidates = [Path(name)]
        elif scheme in ("http", "https"):
            candidates = self._of_fuel(name)
        elif separator and scheme != "file":
            # The first part names a folder below one that is searched, or is the name of that folder itself. Gazebo
            # takes every other scheme, such as models://, for model://.
            first, _, inside = name.partition("/")
            candidates = [near.parent / name]
            for folder in [near, *self.folders]:
                candidates += [folder / name, folder / "models" / name]
                if folder.name == first:
                    candidates.append(folder / inside)
        else:
            candidates = [near / name, *(folder / name for folder in self.folders)]
        for candidate in candidates:
            if os.path.exists(candidate):  # False, too, for a name that is longer than the system allows
                return candidate
        hint = "Name the folder that contains it with --path"
        if scheme in ("http", "https"):
            hint = f"Download it: gz fuel download -u '{uri}'; or name the folder that contains it with --path"
        if "$" in uri:
            hint = "Expand the file first (xacro, envsubst)"
        searched = ", ".join(dict.fromkeys(str(candidate.parent) for candidate in candidates))
        return fail(element, f"'{uri}' is not found", f"a {kind}, searched in {searched}",
                    "another package, or a search path that is not set", hint)

    def _of_fuel(self, name):
        """Where a model HOST/1.0/OWNER/models/NAME is, or a file NAME/VERSION/files/FILE of it.

        Gazebo Fuel keeps what it downloads below folders in small letters, with one for each version.
        """
        head, _, tail = name.rstrip("/").partition("/models/")
        model, _, rest = tail.partition("/")
        inside = rest.partition("files/")[2]
        model = model or head.rpartition("/")[2]
        cache = Path(os.environ.get("GZ_FUEL_CACHE_PATH") or os.path.expanduser("~/.gz/fuel"))
        owned = cache / head.partition("/")[0] / head.rpartition("/")[2].lower() / "models"
        candidates = []
        for folder in [*self.folders, owned]:
            for place in (folder / model, folder / model.lower()):
                versions = filter(str.isdecimal, os.listdir(place) if os.path.isdir(place) else ())
                candidates += [place / version / inside for version in sorted(versions, key=int, reverse=True)]
                candidates.append(place / inside)
        return candidates
