"""Places of the plant that concealed physics may change."""


class Effect:
    """Physics that the nominal model lacks. Each hook does nothing unless it is overridden.

    name        as in diagnosis.json; of foreign physics a word of our own
    joint       1 to 6, None where it has none
    parameters  {name: value}, SI units, names as in diagnosis.json
    """

    name = ""

    def __init__(self, joint=None, **parameters):
        self.joint = joint
        self.parameters = {name: float(value) for name, value in parameters.items()}

    def begin(self, rng, course):
        """Draws what is another in every recording. Returns the Motion or LoadTest as the process
        makes it."""
        return course

    def alter(self, description):
        """Changes numbers of the robot before the plant is built from them."""

    def build(self, assembly):
        """Adds joints, springs, tendons, bodies."""

    def prepare(self, simulation):
        """Looks up what it needs in the compiled model."""

    def prepare_servo(self, servo):
        """Changes the controller."""

    def step(self, simulation, row):
        """Acts before each step of the engine; row is None while a load settles."""

    def sense(self, signals, description):
        """Alters what a sensor sees."""
