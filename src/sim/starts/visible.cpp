#include "sim/start.h"

namespace faba {
namespace {

/// Uniform in the visible part of the arena (theory A13, "start in visible area").
class StartVisible final : public Start {
 public:
  struct Params {};
  static constexpr std::array kTraits = {Trait::in_view};
  static Schema<Params> schema() { return {"visible", "Uniform in the visible part of the arena"}; }
  StartVisible(const Params&, const StartContext& c) : frame_(c.arena->frame()) {}
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    const auto& u = d.u;
    return frame_.world_from_image({u[0] * frame_.width - 0.5, u[1] * frame_.height - 0.5});
  }

 private:
  Frame frame_;
};

}  // namespace

void add_start_visible(StartRegistry& r) { r.add<StartVisible>(); }

}  // namespace faba
