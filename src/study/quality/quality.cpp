#include "study/quality/quality.h"

#include <algorithm>

#include <fmt/format.h>

namespace faba {

const char* word_of(Quality quality) {
  return quality == Quality::good ? "good" : quality == Quality::doubtful ? "doubtful" : "poor";
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
