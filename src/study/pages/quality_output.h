#pragma once
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/data/video_scale.h"
#include "study/quality/quality.h"

namespace faba {

/// Adds `quality` and `warnings` = [{aspect, what, evidence, advice}] to the output of a measurement.
void add_quality(nlohmann::ordered_json& j, const std::vector<Warning>& warnings);
/// Adds `warnings` only, to the output of a run.
void add_warnings(nlohmann::ordered_json& j, const std::vector<Warning>& warnings);
/// Adds `um_per_px` and `um_per_px_source`; null if the scale is not known.
void add_scale(nlohmann::ordered_json& j, const VideoScale& scale);
/// For a page: the quality, and a box for each warning. Empty without warnings.
std::string quality_markup(const std::vector<Warning>& warnings);
/// For a page: a note in its own paragraph, of the class `style`; after the name of its file, if it has one.
std::string note_markup(const std::string& note, const std::string& file, const char* style);

}  // namespace faba
