#include "study/engines/engines.h"

namespace faba {

std::unique_ptr<Engine> make_engine(const EngineSettings& settings, const WorkerCommand& worker) {
  switch (settings.type) {
    case EngineType::local:
      break;
    case EngineType::parallel:
      return parallel_engine(settings, worker);
    case EngineType::slurm:
      return slurm_engine(settings, worker);
    case EngineType::dask:
      return dask_engine(settings, worker);
  }
  return local_engine(settings, worker);
}

}  // namespace faba
