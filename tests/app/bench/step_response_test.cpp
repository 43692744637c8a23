// The note on the schedule of step responses; tests/e2e/bench_use_test.cpp records them.
#include "app/bench/step_response.h"

#include <doctest/doctest.h>

using namespace faba;

TEST_CASE("an interval that is shorter than a response is noted, except 0 and for one response") {
  StepResponseParams p;
  p.gather = 20;
  p.before = 1;
  p.record = 11;
  p.repeat = 3;
  p.every = 1;
  CHECK(schedule_note(p) ==
        "rig.step_response.every (--every): 1 s is shorter than one response (about 32 s); responses follow "
        "each other immediately");
  p.every = 32;
  CHECK(schedule_note(p).empty());
  p.every = 0;
  CHECK(schedule_note(p).empty());
  p.every = 1;
  p.repeat = 1;
  CHECK(schedule_note(p).empty());
}
