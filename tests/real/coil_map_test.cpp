// Fit to the measured field map of a flat coil. Skipped if the file is absent.
#include <doctest/doctest.h>

#include "study/coils/field_fit.h"
#include "tests/skip.h"

using namespace faba;

TEST_CASE("the measured map of a flat coil is fitted to 0.024 G") {
  const std::filesystem::path file = std::filesystem::path(FABA_SHARED_DATA) / "coil/loop_bz_map.csv";
  if (test::skipped_without(file)) return;
  const FieldFit fit = field_fit(FABA_SCENES "/../rigs/flat-coil.toml", file);
  // Values of the description of the data, to the digits given there.
  CHECK(fit.rms == doctest::Approx(0.024e-4).epsilon(0.02));
  CHECK(fit.best.gain == doctest::Approx(1.036).epsilon(0.0005));
  CHECK(-fit.best.shift[2] == doctest::Approx(1.88e-2).epsilon(0.003));
  CHECK(fit.best.offset[2] == doctest::Approx(-0.11e-4).epsilon(0.05));
}
