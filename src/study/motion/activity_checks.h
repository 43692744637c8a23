#pragma once
#include <optional>

#include "study/motion/response.h"
#include "study/motion/signature.h"
#include "study/motion/video_look.h"
#include "study/quality/quality.h"

namespace faba {

/// The brightness changes between frames by more than the flow of a pixel at the threshold; `px_side` is
/// FlowSource::shrink().
std::optional<Warning> light_warning(const LightChange& light, int px_side, double threshold_px);

/// Flows along a direction and against it at the same time, which cancel in along(): cells of both
/// polarities.
std::optional<Warning> opposite_warning(const Signature& signature, double direction_deg);

/// No response, although the velocity changes in another direction than the given one, or although many cells
/// move along it.
std::optional<Warning> no_response_warning(const Response& response);

/// Much of the contrast of all objects stays beside the edge of a drop, where the fraction of the objects
/// that respond is less certain than its interval.
std::optional<Warning> edge_warning(const Response& response);

}  // namespace faba
