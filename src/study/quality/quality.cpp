#include "study/quality/quality.h"

#include <algorithm>

#include <fmt/format.h>

namespace faba {

const char* word_of(Quality quality) {
  return quality == Quality::good ? "good" : quality == Quality::doubtful ? "doubtful" : "poor";
}

const char* meaning_of(Quality quality) {
  switch (quality) {
    case Quality::good:
      return "No violated assumption of the measurement was detected";
    case Quality::doubtful:
      return "An assumption of the measurement is violated; the error may be larger than the stated interval";
    case Quality::poor:
      return "An assumption that the measurement needs is violated; the result must be expected to be wrong";
  }
  return "";
}

Quality quality_of(const std::vector<Warning>& warnings) {
  Quality worst = Quality::good;
  for (const Warning& w : warnings) worst = std::max(worst, w.quality);
  return worst;
}

std::string sentence(const Warning& w) {
  std::string text = fmt::format("{}: {}", w.aspect, w.what);
  if (!w.evidence.empty()) text += fmt::format(" ({})", w.evidence);
  if (!w.advice.empty()) text += "; " + w.advice;
  return text;
}

}  // namespace faba
