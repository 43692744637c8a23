#pragma once
#include "core/archive.h"
#include "study/identify/legacy_selection.h"
#include "study/identify/response_video.h"

namespace faba {

/// Writes or reads the measurement of a video. The input and the statistics, which are made from the
/// episodes, are not included.
void archive_response(Archive& a, ResponseVideo& v);

/// Writes or reads the references of a video.
void archive_references(Archive& a, std::vector<LegacyReference>& references);

}  // namespace faba
