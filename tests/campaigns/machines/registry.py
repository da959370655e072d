"""The machines, by the names of their folders."""

from . import (emps, franka_panda, friction_damper, hilti_jaibot, kuka_kr300, motoman_ma1400, pal_tiago,
               staubli_tx40, unisa_panda, unisa_ur10, ur5)

MACHINES = {module.__name__.rpartition(".")[2]: module
            for module in (kuka_kr300, franka_panda, staubli_tx40, emps, friction_damper, ur5,
                          hilti_jaibot, unisa_ur10, unisa_panda, motoman_ma1400, pal_tiago)}
