#include "cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace faba::cli {
namespace {

// Without the escape sequence that erases a line, as with TERM=dumb, every update would be a new line.
bool can_erase() {
  const char* kind = std::getenv("TERM");
  return kind && std::strcmp(kind, "dumb") != 0;
}

// Width of the bar beside a label of `label` characters, limited by the width of the terminal.
int bar_width(std::size_t label) {
  constexpr int kMax = 30, kNumbers = 22;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kMax;
  return std::clamp(int(size.ws_col) - int(label) - kNumbers, 0, kMax);
}

constexpr double kReportPeriod = 0.1;  // s

int progress_descriptor() {
  const char* value = std::getenv("FABA_PROGRESS_FD");
  return value && *value >= '0' && *value <= '9' ? std::atoi(value) : -1;
}

std::string clock_time(double s) {
  const auto seconds = std::llround(s);
  if (seconds >= 3600) return fmt::format("{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60);
  return fmt::format("{}:{:02}", seconds / 60, seconds % 60);
}

}  // namespace

Progress::Progress(std::string what, bool enabled)
    : what_(std::move(what)),
      enabled_(enabled && isatty(STDERR_FILENO) && can_erase()),
      report_descriptor_(progress_descriptor()) {}

Progress::~Progress() { clear(); }

void Progress::report(std::uint64_t done, std::uint64_t total) const {
  const std::string line = fmt::format("{} {} {}\n", what_, done, total);
  if (::write(report_descriptor_, line.data(), line.size()) < 0) return;  // the reader has closed it
}

void Progress::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  const auto now = Clock::now();
  if (report_descriptor_ >= 0 &&
      (done == total || std::chrono::duration<double>(now - reported_).count() > kReportPeriod)) {
    reported_ = now;
    report(done, total);
  }
  if (!enabled_) return;
  if (!started_) {
    started_ = true;
    first_ = done > 0 ? done - 1 : 0;
  }
  const double elapsed = std::chrono::duration<double>(now - began_).count();
  if (elapsed < 1 || std::chrono::duration<double>(now - drawn_).count() < 0.1) return;
  drawn_ = now;
  shown_ = true;
  if (total == 0) {
    std::fputs(fmt::format("\r\033[K{}: {}", what_, done).c_str(), stderr);
    std::fflush(stderr);
    return;
  }
  const double fraction = double(done) / double(total);
  const double remaining = elapsed * double(total - done) / double(std::max<std::uint64_t>(done - first_, 1));
  const int width = bar_width(what_.size()), full = int(fraction * width);
  const std::string bar = fmt::format("\r\033[K{} [{:#<{}}{: <{}}] {:3.0f} %  {} left", what_, "", full, "",
                                      width - full, 100 * fraction, clock_time(remaining));
  std::fputs(bar.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace faba::cli
