#pragma once
#include <memory>

#include "app/sinks/sinks.h"
#include "core/table.h"

namespace faba {

/// series.csv: one line per turn (docs/formats/run-directory.md).
class SeriesSink : public RunSink {
 public:
  /// The rows as they are in the file. They are kept in memory up to a million turns, 20 columns of which are
  /// 160 MB; a run that is longer, or was resumed, is read from the file. Call after finish().
  virtual Table rows() const = 0;
};

/// `resume` is null, or the archive to read its checkpoint from.
std::unique_ptr<SeriesSink> series_sink(const SinkContext& c, Archive* resume);

}  // namespace faba
