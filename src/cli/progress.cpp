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

// Columns of the terminal; 0: unknown.
int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? int(size.ws_col) : 0;
}

// Width of the bar beside a label of `label` characters, limited by the width of the terminal.
int bar_width(std::size_t label) {
  constexpr int kMax = 30, kNumbers = 22;
  const int width = terminal_width();
  return width == 0 ? kMax : std::clamp(width - int(label) - kNumbers, 0, kMax);
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

void Progress::update(std::uint64_t done, std::uint64_t total, const std::string& waiting) {
  const auto now = Clock::now();
  if (!waiting.empty()) began_ += now - updated_;
  updated_ = now;
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
  if ((elapsed < 1 && waiting.empty()) || std::chrono::duration<double>(now - drawn_).count() < 0.1) return;
  drawn_ = now;
  shown_ = true;
  if (total == 0) {
    std::fputs(fmt::format("\r\033[K{}: {}", what_, done).c_str(), stderr);
    std::fflush(stderr);
    return;
  }
  const double fraction = double(done) / double(total);
  const double remaining = elapsed * double(total - done) / double(std::max<std::uint64_t>(done - first_, 1));
  std::string right = waiting.empty() ? clock_time(remaining) + " left" : waiting;
  const int width = bar_width(what_.size()) / (waiting.empty() ? 1 : 3), full = int(fraction * width);
  constexpr int kBesideBar = 11;  // characters of " [] 100 %  ", and the last column
  if (const int columns = terminal_width(); columns > 0)
    right = right.substr(0, std::size_t(std::max(0, columns - int(what_.size()) - width - kBesideBar)));
  const std::string bar = fmt::format("\r\033[K{} [{:#<{}}{: <{}}] {:3.0f} %  {}", what_, "", full, "",
                                      width - full, 100 * fraction, right);
  std::fputs(bar.c_str(), stderr);
  std::fflush(stderr);
}

std::function<void(std::uint64_t, std::uint64_t)> over_rounds(Progress& bar, std::uint64_t total) {
  return [&bar, total, before = std::uint64_t(0), last = std::uint64_t(0)](std::uint64_t done,
                                                                           std::uint64_t) mutable {
    if (done < last) before += last;
    last = done;
    bar.update(std::min(before + done, total), total);
  };
}

}  // namespace faba::cli
