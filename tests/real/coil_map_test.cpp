// A measured map of a flat coil, fitted. Skipped where it is not there.
#include <doctest/doctest.h>

#include "study/coils/field_report.h"

using namespace faba;

TEST_CASE("the measured map of a flat coil is fitted to 0.024 G") {
  const std::filesystem::path file = std::filesystem::path(FABA_SHARED_DATA) / "coil/loop_bz_map.csv";
  if (!std::filesystem::exists(file)) {
    MESSAGE("skipped: no real data");
    return;
  }
  const auto j = field_fit(FABA_SCENES "/../rigs/flat-coil.toml", file, {}, {});
  // As the data's own description says, to the digits that it gives.
  CHECK(j["rms_t"].get<double>() == doctest::Approx(0.024e-4).epsilon(0.02));
  CHECK(j["gain"].get<double>() == doctest::Approx(1.036).epsilon(0.0005));
  CHECK(-j["shift_m"][2].get<double>() == doctest::Approx(1.88e-2).epsilon(0.003));
  CHECK(j["offset_t"][2].get<double>() == doctest::Approx(-0.11e-4).epsilon(0.05));
}
