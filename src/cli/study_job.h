#pragma once
#include <memory>
#include <string>
#include <vector>

#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"

namespace faba::cli {

struct Common;

/// A study of many simulations or videos: what its verb computes, and what `faba study` plans, works on and
/// collects. Each kind of study has one class, in the file of its verb.
class StudyJob {
 public:
  virtual ~StudyJob() = default;
  /// How the study is read again; stored in the directory of the study.
  virtual StudySource source() const = 0;
  /// Hash of everything that the result depends on.
  virtual const std::string& hash() const = 0;
  /// NAME of the file NAME.json with the result.
  virtual std::string report() const = 0;
  /// Computes what is missing, and writes the result and the pages of a complete study. Returns whether it is
  /// complete. Throws the errors of sweep().
  virtual bool run(StudyDirectory& dir, SweepOptions options, const Common& c) = 0;
  /// Prints the result of the study that run() has completed.
  virtual void print(const StudyDirectory& dir, const Common& c) const = 0;
  /// The tasks of a round from its description. `measured`: folder of measurements, see SweepOptions. The job
  /// must outlive the round.
  virtual Round round(const std::filesystem::path& measured, const std::string& description) const = 0;
  /// Names of the first values of a result.
  virtual std::vector<std::string> value_names() const { return {}; }
};

/// The job of a study. `needs_inputs`: false for a worker, which does not read the videos. Throws the errors
/// of reading the study.
std::unique_ptr<StudyJob> identify_job(const StudySource& source, bool needs_inputs);
std::unique_ptr<StudyJob> calibrate_job(const StudySource& source, bool needs_inputs);
std::unique_ptr<StudyJob> controllers_job(const StudySource& source);
std::unique_ptr<StudyJob> tune_job(const StudySource& source);
std::unique_ptr<StudyJob> track_job(const StudySource& source);
std::unique_ptr<StudyJob> activity_job(const StudySource& source);

/// The job for the verb of the source.
std::unique_ptr<StudyJob> study_job(const StudySource& source, bool needs_inputs);

}  // namespace faba::cli
