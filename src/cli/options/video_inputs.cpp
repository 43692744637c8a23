#include "cli/options/video_inputs.h"

#include <algorithm>

#include "core/error.h"
#include "core/file.h"
#include "core/hash.h"
#include "study/data/run_video.h"

namespace faba::cli {

VideoInputs::VideoInputs(StudySource& source, const std::vector<std::filesystem::path>& files)
    : stored_(!source.inputs.empty()) {
  Provenance all;
  if (stored_) {
    for (const auto& file : files) {
      const auto same = [&](const auto& one) { return one.path == file.string(); };
      if (file.empty() || std::ranges::any_of(all.inputs, same)) continue;
      const std::size_t n = all.inputs.size();
      all.inputs.push_back({file.string(), n < source.inputs.size() ? source.inputs[n] : ""});
    }
    if (all.inputs.size() != source.inputs.size())
      throw Error(Errc::usage, "", "the study has other inputs than when it was planned");
  } else {
    for (const auto& file : files) all.add(file);
    for (const auto& input : all.inputs) source.inputs.push_back(input.sha256);
  }
  inputs = std::move(all.inputs);
  Hash h;
  h.text(source.verb);
  for (const std::string& word : source.options) h.text("\n" + word);
  for (const auto& input : inputs) {
    h.text("\n" + input.sha256);
    // The manifest of a run has its scale and the time of the field reversal.
    if (is_run(input.path)) h.text(read_file(std::filesystem::path(input.path) / "manifest.json"));
  }
  hash = h.hex();
}

const Provenance::Input& VideoInputs::of(const std::filesystem::path& file) const {
  return *std::ranges::find(inputs, file.string(), &Provenance::Input::path);
}

void VideoInputs::check(const std::filesystem::path& file) const {
  if (stored_ && content_digest(file) != of(file).sha256)
    throw Error(Errc::input, file.string(), "has changed since the study was planned");
}

}  // namespace faba::cli
