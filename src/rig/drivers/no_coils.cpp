#include <algorithm>
#include <cmath>

#include "rig/coil_driver.h"

namespace faba {
namespace {

/// No device: for observation without actuation.
class NoCoils final : public CoilDriver {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::no_current};
  static Schema<Params> schema() {
    return Schema<Params>("none", "No device: commands are computed and recorded, but not executed");
  }
  NoCoils(const Params&, const DriverContext&) {}
  Status write(std::span<const double>, bool) override { return {}; }
  Status sense(std::span<double> volts) override {
    std::fill(volts.begin(), volts.end(), std::nan(""));
    return {};
  }
  std::string unsafe() const override { return ""; }
};

}  // namespace

void add_no_coils(CoilDriverRegistry& r) { r.add<NoCoils>(); }

}  // namespace faba
