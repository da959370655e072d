#pragma once

#include <unity.h>

// Unity defines these as macros where <math.h> has none, which breaks std::isnan.
#undef isinf
#undef isnan

// Unity calls these around each test; ours need nothing.
extern "C" void setUp() {}
extern "C" void tearDown() {}
