#pragma once
#include <stdexcept>
#include <string>

namespace faba {

/// Kinds of failure that a caller may distinguish; the value is the exit code of the program.
enum class Errc {
  internal = 1,      ///< a bug, a full disk, or anything not listed below
  usage = 2,         ///< invalid command line, scenario, coil system or study file
  input = 3,         ///< a picture, video or data file that is missing, unreadable or unsuitable
  device = 4,        ///< camera or coil driver
  busy = 11,         ///< another process uses the directory; the same command can succeed later
  interrupted = 130  ///< stopped by a signal; the recorded data are kept
};

/// The only exception type of the library. `where` is the location in the user's terms (a scenario path such
/// as `swarm[0].model.speed`, a file, a device), never a C++ file; `what` is one line: the reason and what to
/// do.
class Error : public std::runtime_error {
 public:
  Error(Errc code, std::string where, const std::string& what)
      : std::runtime_error(one_line(where.empty() ? what : where + ": " + what)),
        code_(code),
        where_(std::move(where)) {}
  Errc code() const noexcept { return code_; }
  const std::string& where() const noexcept { return where_; }
  /// what() without the location.
  std::string reason() const { return where_.empty() ? what() : what() + where_.size() + 2; }

 private:
  // Names and values come from users' files and may contain control characters.
  static std::string one_line(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
  }
  Errc code_;
  std::string where_;
};

}  // namespace faba
