#include "study/engines/engine.h"

namespace faba {

std::vector<std::string> WorkerCommand::words(const Attempt& a) const {
  return {program.string(), "study", "work",      directory.string(), "--quiet",
          "--tasks",        a.tasks, "--results", a.results.string()};
}

}  // namespace faba
