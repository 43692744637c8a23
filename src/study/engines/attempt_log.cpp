#include "study/engines/attempt_log.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>

#include "core/table.h"

namespace faba {
AttemptLog::AttemptLog(const std::filesystem::path& file, std::string engine) : engine_(std::move(engine)) {
  std::error_code ec;
  const auto size = std::filesystem::exists(file, ec) ? std::filesystem::file_size(file) : 0;
  file_ = std::make_unique<OutputFile>(file, size);
  if (size == 0) file_->append("time,engine,attempt,event,tasks,detail\n");
}

void AttemptLog::add(const std::string& attempt, std::string_view event, const std::string& tasks,
                     const std::string& detail) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  file_->append(fmt::format("{:%FT%TZ},{},{},{},{},{}\n", fmt::gmtime(now), engine_, attempt, event,
                            csv_field(tasks), csv_field(detail)));
}

}  // namespace faba
