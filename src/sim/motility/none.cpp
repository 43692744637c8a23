#include "sim/motility.h"

namespace faba {
namespace {

/// No effect of air: cells keep speed and response.
class MotilityNone final : public Motility {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::inert};
  static Schema<Params> schema() {
    return Schema<Params>("none", "No effect of air: cells keep speed and response");
  }
  MotilityNone(const Params&, const MotilityContext&) {}
  std::vector<ColumnSpec> columns() const override { return {}; }
  void start(State&, std::size_t, std::size_t, std::uint64_t) const override {}
  double speed_factor(double) const override { return 1; }
  void step(State&, const StepContext&) const override {}
};

}  // namespace

void add_motility_none(MotilityRegistry& r) { r.add<MotilityNone>(); }

}  // namespace faba
