#pragma once
#include <string>

namespace faba {

/// Loads the libraries for videos in a thread, so that the first video need not wait for them. An error is
/// reported when they are used.
void load_video_libraries();

/// Loads them now; returns why they cannot be loaded, or an empty text.
std::string problem_of_video_libraries();

}  // namespace faba
