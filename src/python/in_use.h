#pragma once
#include <atomic>
#include <string>

namespace faba::python {

/// An object that one thread may use at a time, in the process that created it if it has threads.
class Exclusive {
 public:
  /// `name`: of its class, for messages.
  explicit Exclusive(std::string name);
  unsigned threads = 1;  ///< of its pool

 private:
  friend class InUse;
  std::string name_;
  int process_;
  std::atomic<bool> used_{false};
};

/// While it exists, no other thread and no part of the object's control loop may use the object. Throws
/// Error(usage).
class InUse {
 public:
  explicit InUse(Exclusive& object);
  ~InUse();
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  Exclusive& object_;
};

}  // namespace faba::python
