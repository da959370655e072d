// What tools/support/whole_fp_state.c tells tools/support/patient_clock.c.
#pragma once

// The guest's first program begins.
void begin_patience(void);
