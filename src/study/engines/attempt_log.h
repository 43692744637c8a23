#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "core/file.h"

namespace faba {

/// The file attempts.csv of a study: what the engine started, how it ended, and what was submitted again.
/// Columns: time (UTC), engine, attempt, event, tasks, detail.
class AttemptLog {
 public:
  /// Continues the file. Throws Error(internal).
  AttemptLog(const std::filesystem::path& file, std::string engine);
  void add(const std::string& attempt, std::string_view event, const std::string& tasks,
           const std::string& detail);

 private:
  std::unique_ptr<OutputFile> file_;
  std::string engine_;
};

}  // namespace faba
