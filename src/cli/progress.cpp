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

// Without the sequence that erases a line, as on TERM=dumb, a bar would be one line after the other.
bool can_erase() {
  const char* kind = std::getenv("TERM");
  return kind && std::strcmp(kind, "dumb") != 0;
}

// Of the bar: what a narrow terminal leaves beside the words.
int bar_width(std::size_t words) {
  constexpr int kMost = 30, kNumbers = 22;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kMost;
  return std::clamp(int(size.ws_col) - int(words) - kNumbers, 0, kMost);
}

constexpr double kTellEvery = 0.1;  // s

int descriptor() {
  const char* named = std::getenv("FABA_PROGRESS_FD");
  return named && *named >= '0' && *named <= '9' ? std::atoi(named) : -1;
}

std::string clock_time(double s) {
  const auto whole = std::llround(s);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string what, bool enabled)
    : what_(std::move(what)),
      enabled_(enabled && isatty(STDERR_FILENO) && can_erase()),
      told_to_(descriptor()) {}

Progress::~Progress() { clear(); }

void Progress::tell(std::uint64_t done, std::uint64_t total) const {
  const std::string line = fmt::format("{} {} {}\n", what_, done, total);
  if (::write(told_to_, line.data(), line.size()) < 0) return;  // whoever asked has gone
}

void Progress::clear() {
  if (shown_) std::fputs("\r\033[K", stderr);
  shown_ = false;
}

void Progress::update(std::uint64_t done, std::uint64_t total) {
  const auto now = Clock::now();
  if (told_to_ >= 0 && (done == total || std::chrono::duration<double>(now - told_).count() > kTellEvery)) {
    told_ = now;
    tell(done, total);
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
  const double left = elapsed * double(total - done) / double(std::max<std::uint64_t>(done - first_, 1));
  const int width = bar_width(what_.size()), full = int(fraction * width);
  const std::string bar = fmt::format("\r\033[K{} [{:#<{}}{: <{}}] {:3.0f} %  {} left", what_, "", full, "",
                                      width - full, 100 * fraction, clock_time(left));
  std::fputs(bar.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace faba::cli
