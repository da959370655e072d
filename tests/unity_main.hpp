#pragma once

#include <unity.h>

// Unity calls these around each test; ours need nothing.
extern "C" void setUp() {}
extern "C" void tearDown() {}
