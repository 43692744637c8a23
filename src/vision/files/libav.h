#pragma once
#include <string>

namespace faba::libav {

/// Stops libavformat and libavcodec from printing; what they would have said is kept for reason(). Cheap, and
/// safe to call from any thread: every entry into those libraries calls it first.
void quiet();

/// Forgets what the libraries said on this thread, so that the next reason() speaks of the next call only.
void forget_messages();

/// The first complaint (level error or worse) of the libraries on this thread since forget_messages(); empty
/// if none.
std::string first_message();

/// One line for a libav error number (negative), followed by first_message() in brackets when there is one.
std::string reason(int error_number);

/// Deleter for the libraries' objects, all of which are freed by a function that takes the pointer's address.
template <auto free_by_address>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    free_by_address(&object);
  }
};

}  // namespace faba::libav
