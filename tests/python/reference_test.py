"""docs/reference/python.md is that of the package: tools/python_reference.py writes it."""

import sys
import unittest

from common import ROOT, main

import faba

sys.path.insert(0, str(ROOT / "tools"))
import python_reference  # noqa: E402


class Reference(unittest.TestCase):
    def test_the_page_is_that_of_the_package(self):
        self.assertEqual(
            (ROOT / python_reference.PAGE).read_text(), python_reference.page(ROOT), "run: tools/make_docs.py, with the package built"
        )

    def test_every_public_name_has_a_docstring(self):
        for name in faba.__all__:
            thing = getattr(faba, name)
            if name.startswith("__"):
                continue
            self.assertTrue((thing.__doc__ or "").strip(), name)
            if isinstance(thing, type):
                for member, value in vars(thing).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        self.assertTrue((value.__doc__ or "").strip(), f"{name}.{member}")


if __name__ == "__main__":
    main()
