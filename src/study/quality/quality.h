#pragma once
#include <string>
#include <vector>

namespace faba {

/// How far the answer of a measurement can be trusted. `good`: no violated assumption was detected;
/// `doubtful`: one was, and the answer may be wrong by more than its interval; `poor`: it must be expected to
/// be wrong.
enum class Quality { good, doubtful, poor };
const char* word_of(Quality quality);
/// The meaning of the word, one sentence without a period.
const char* meaning_of(Quality quality);

/// A violated assumption of a measurement. The texts are parts of the sentence "aspect: what (evidence);
/// advice".
struct Warning {
  std::string aspect;                   ///< what it concerns, one word such as "scale" or "texture"
  std::string what;                     ///< the violated assumption
  std::string evidence;                 ///< the figures that show it; may be empty
  std::string advice;                   ///< what to do; may be empty
  Quality quality = Quality::doubtful;  ///< of the answer because of it
};

/// Title of an aspect for people: "Frame rate" of "frame_rate".
std::string title_of_aspect(const std::string& aspect);
/// The lowest quality of all warnings; good without warnings.
Quality quality_of(const std::vector<Warning>& warnings);
/// "texture: the picture is full of detections (1200 per frame); give --size".
std::string sentence(const Warning& warning);

}  // namespace faba
