"""Says that the wheel is for one kind of machine, and for every Python: the library in it is loaded by cffi."""

import setuptools
from setuptools.command.bdist_wheel import bdist_wheel


class OfOneMachine(bdist_wheel):
    def finalize_options(self):
        super().finalize_options()
        self.root_is_pure = False

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


setuptools.setup(cmdclass={"bdist_wheel": OfOneMachine})
