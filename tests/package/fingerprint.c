#include <inttypes.h>
#include <stdio.h>

#include "robot_model.h"

/* Prints the fingerprint that the header states, and the one that the core finds of its model. */
int main(void) {
  if (flexcomp_model_validate(&robot_model) != FLEXCOMP_OK) {
    return 1;
  }
  printf("%016" PRIx64 " %016" PRIx64 "\n", ROBOT_MODEL_HASH, flexcomp_model_hash(&robot_model));
  return 0;
}
