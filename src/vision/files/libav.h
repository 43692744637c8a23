#pragma once
#include <string>

namespace faba::libav {

/// Redirects the log of libavformat and libavcodec: nothing is printed, the first error is kept for reason().
/// Cheap and thread-safe; every function that uses these libraries calls it first.
void quiet();

/// Clears the log messages of this thread, so that the next reason() refers to the next call only.
void forget_messages();

/// First log message of level error or worse on this thread since forget_messages(); empty if there were no
/// errors.
std::string first_message();

/// Description of a libav error code (negative) in one line, followed by first_message() in brackets, if
/// there is one.
std::string reason(int error_number);

}  // namespace faba::libav
