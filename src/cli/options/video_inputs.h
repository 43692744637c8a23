#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/data/provenance.h"
#include "study/sweep/study_directory.h"

namespace faba::cli {

/// The videos and other files of a study whose options name all of its inputs.
struct VideoInputs {
  std::vector<Provenance::Input> inputs;  ///< each path once
  std::string hash;  ///< of the study: its command, options and the content of the inputs

  VideoInputs() = default;
  /// Sets the digests of `source`, or takes them from there: a worker does not read all videos.
  VideoInputs(StudySource& source, const std::vector<std::filesystem::path>& files);
  /// One of the inputs.
  const Provenance::Input& of(const std::filesystem::path& file) const;
  /// A worker reads its own video: throws Error(input) if it has changed.
  void check(const std::filesystem::path& file) const;

 private:
  bool stored_ = false;  ///< the digests are from the directory of the study
};

}  // namespace faba::cli
