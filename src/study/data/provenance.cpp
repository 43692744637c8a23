#include "study/data/provenance.h"

#include <algorithm>

#include <fmt/format.h>

#include "study/data/run_video.h"
#include "study/data/sha256.h"
#include "vision/files/picture_sequence.h"

namespace faba {
namespace {

// The files from which a measurement of a run directory reads.
std::vector<std::filesystem::path> measured_files(const std::filesystem::path& run) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"flow.h5", "video.avi", "video.mp4"})
    if (std::filesystem::exists(run / name)) files.push_back(run / name);
  return files;
}

}  // namespace

std::string content_digest(const std::filesystem::path& input) {
  const bool run = is_run(input);
  if (!run && !is_picture_sequence(input)) return sha256_of(input);
  Sha256 all;
  for (const auto& file : run ? measured_files(input) : sequence_files(input))
    all.add(fmt::format("{}  {}\n", sha256_of(file), file.filename().string()));
  return all.hex();
}

void Provenance::add(const std::filesystem::path& input) {
  const std::string path = input.string();
  const auto same = [&](const Input& one) { return one.path == path; };
  if (path.empty() || std::any_of(inputs.begin(), inputs.end(), same)) return;
  inputs.push_back({path, content_digest(input)});
}

}  // namespace faba
