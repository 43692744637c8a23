#include "cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace faba::cli {
namespace {

constexpr int kWidth = 30;

std::string clock_time(double s) {
  const auto whole = std::llround(s);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string what, bool enabled)
    : what_(std::move(what)), enabled_(enabled && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  if (!enabled_ || total == 0) return;
  if (!started_) started_ = true, first_ = done > 0 ? done - 1 : 0;
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - began_).count();
  if (elapsed < 1 || std::chrono::duration<double>(now - drawn_).count() < 0.1) return;
  drawn_ = now;
  shown_ = true;
  const double fraction = double(done) / double(total);
  const double left = elapsed * double(total - done) / double(std::max<std::uint64_t>(done - first_, 1));
  const int full = int(fraction * kWidth);
  fmt::print(stderr, "\r\033[K{} [{:#<{}}{: <{}}] {:3.0f} %  {} left", what_, "", full, "", kWidth - full,
             100 * fraction, clock_time(left));
  std::fflush(stderr);
}

}  // namespace faba::cli
