#pragma once
#include <cstdint>

namespace faba {

/// Its thread answers to a device: while this lives, it is run before others as far as the system lets it (a
/// lower niceness where that is allowed, a shorter slice of time where the scheduler knows one, Linux 6.12),
/// and afterwards as before. Only to be there sooner: nothing may depend on it.
class Urgent {
 public:
  Urgent() noexcept;
  ~Urgent();
  Urgent(const Urgent&) = delete;
  Urgent& operator=(const Urgent&) = delete;

 private:
  std::int32_t niceness_;  ///< before
};

}  // namespace faba
