"""A force sensor in flexcompd's configuration. The arm's geometry there is judged where a sensor is played (hil/)."""

import unittest

from command import KR270, Command


class Sensor(Command):
    def arguments(self, *options):
        return ["configure", "--model", KR270, "--out", self.folder / "node.toml", *options]

    def test_it_is_written_with_the_arm(self):
        self.run_well(*self.arguments("--sensor", "10.0.0.3:49152", "--sensor-frame", "0,0,0.05"))
        node = (self.folder / "node.toml").read_text()
        self.assertIn('sensor = "udp://10.0.0.3:49152"', node)
        self.assertEqual(6, node.count("sensor-joint-"))

    def test_over_rsi_it_is_all_that_the_telegrams_lack(self):
        said = self.run_well(*self.arguments("--sensor", "10.0.0.3:49152", "--rsi", self.folder / "kuka"))
        self.assertIn("without-identity = true", (self.folder / "node.toml").read_text())
        self.assertNotIn("--can", said)

    def test_what_cannot_be_is_refused_and_nothing_written(self):
        for address in ("10.0.0.3", "10.0.0.3:0", "host:49152"):
            self.assert_refused(*self.arguments("--sensor", address), saying="--sensor")
        for frame in ("0,0,50.1", "0,0", "0,0,0,0,90,0"):
            self.assert_refused(*self.arguments("--sensor", "10.0.0.3:49152", "--sensor-frame", frame),
                                saying="--sensor-frame")
        self.assert_refused(*self.arguments("--sensor-frame", "0,0,0"), saying="requires --sensor")
        self.assert_refused(*self.arguments("--sensor", "10.0.0.3:49152", "--rsi", self.folder / "kuka", "--rsi-force"),
                            saying="--rsi-force")


if __name__ == "__main__":
    unittest.main()
