#include "app/recording/manifest.h"

namespace faba {

Json scenario_manifest(const Scenario& s, std::uint64_t seed, const Frame& frame, const Outline& outline) {
  Json arena = {{"type", s.arena.type}, {"centre_px", {outline.centre_image.x, outline.centre_image.y}}};
  if (outline.radius_px > 0)
    arena["radius_px"] = outline.radius_px;
  else
    arena["size_px"] = {frame.width, frame.height};
  return {{"version", FABA_VERSION},
          {"title", s.params.title},
          {"scenario_hash", s.hash()},
          {"seed", seed},
          {"um_per_px", s.scale.um_per_px},
          {"view_px", {frame.width, frame.height}},
          {"arena", arena},
          {"polarity", s.polarity() > 0 ? "north" : "south"}};
}

}  // namespace faba
