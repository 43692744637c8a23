#include "app/scenario/control_rules.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace faba {
namespace {

std::string quoted(const std::vector<std::string>& names) {
  return fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

}  // namespace

void check_control(const Node& root, const Scenario& s, const Parts& parts) {
  const Trait unsuitable = s.sees_pictures() ? Trait::needs_positions : Trait::needs_pictures;
  const auto suitable_estimators = [&] {
    return quoted(parts.estimator.names_without({Trait::no_estimate, unsuitable}));
  };
  const std::vector<std::string> idle = parts.estimator.names_with(Trait::no_estimate);
  if (s.steers() && s.estimator.has(Trait::no_estimate) &&
      std::find(idle.begin(), idle.end(), s.estimator.type) == idle.end())
    throw Error(
        Errc::usage, root.where("estimator.source"),
        fmt::format("estimator \"{}\" gets no estimate from its source; remove source, or choose one of {}",
                    s.estimator.type, suitable_estimators()));
  if (s.steers() && s.estimator.has(Trait::no_estimate))
    throw Error(Errc::usage, root.where("estimator"),
                fmt::format("controller {} needs an estimate, but estimator \"{}\" gives none; use one of {}",
                            s.controller.type, s.estimator.type, suitable_estimators()));
  if (!s.sees_pictures() && s.estimator.has(Trait::needs_pictures))
    throw Error(Errc::usage, root.where("estimator"),
                fmt::format("\"{}\" needs pictures, but a camera with sensor = \"positions\" gives none; set "
                            "camera.sensor = \"frames\"",
                            s.estimator.type));
  if (s.sees_pictures() && s.estimator.has(Trait::needs_positions))
    throw Error(
        Errc::usage, root.where("estimator"),
        fmt::format("\"{}\" needs the positions of all cells, but a camera with sensor = \"frames\" gives "
                    "none; use one of {}",
                    s.estimator.type, suitable_estimators()));
  if (s.steers() && s.reference.has(Trait::no_target))
    throw Error(Errc::usage, root.where("reference"),
                fmt::format("controller {} needs a target, but reference \"{}\" gives none; use one of {}",
                            s.controller.type, s.reference.type,
                            quoted(parts.reference.names_without({Trait::no_target}))));
}

}  // namespace faba
