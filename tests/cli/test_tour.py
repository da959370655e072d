"""tools/tour on a robot: everything on default options, in under a minute."""

import os
import subprocess
import unittest

from command import FLEXCOMP, ROBOTS, SOURCE, Command

FOREIGN = SOURCE / "build/tour/robots/rtbdata/xacro/kuka_description/kuka_kr210/urdf/kr210l150.urdf"


class Tour(Command):
    def take(self, urdf):
        done = subprocess.run([str(SOURCE / "tools/tour"), str(urdf)], capture_output=True, text=True,
                              env={**os.environ, "FLEXCOMP_BIN": str(FLEXCOMP.parent),
                                   "FLEXCOMP_TOUR": str(self.folder)})
        self.assertEqual(0, done.returncode, done.stdout + done.stderr)
        self.assertIn("% of the uncorrected", done.stdout)

    def test_a_robot_of_the_study(self):
        self.take(ROBOTS / "kr360" / "kr360.urdf")

    @unittest.skipUnless(FOREIGN.exists(), "tools/tour has not fetched the robots of rtb-data yet")
    def test_a_robot_that_others_described(self):
        self.take(FOREIGN)


if __name__ == "__main__":
    unittest.main()
