#include "app/recording/run_lock.h"

#include <fmt/format.h>

#include <fstream>

namespace faba {
namespace {

constexpr const char* kSecond = "This run is not complete. ";

std::string marker_text(const std::filesystem::path& dir, const std::string& program) {
  if (program.empty()) return fmt::format("{}It was recorded on a bench and cannot be resumed.\n", kSecond);
  return fmt::format("{}Resume it with: {} resume {}\n", kSecond, program, dir.string());
}

}  // namespace

RunLock::RunLock(const std::filesystem::path& dir, const std::string& program)
    : lock_(dir / kFile, dir, marker_text(dir, program)) {}

bool RunLock::marks(const std::filesystem::path& dir) {
  std::ifstream in(dir / kFile);
  std::string first, second;
  return std::getline(in, first) && std::getline(in, second) && second.starts_with(kSecond);
}

}  // namespace faba
