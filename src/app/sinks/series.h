#pragma once
#include <memory>

#include "app/sinks/sinks.h"
#include "core/table.h"

namespace faba {

/// series.csv: one line per control cycle (docs/formats/run-directory.md).
class SeriesSink : public RunSink {
 public:
  /// The rows of the file. Up to a million rows are kept in memory (160 MB with 20 columns); for a longer or
  /// resumed run they are read from the file. To be called after finish().
  virtual Table rows() const = 0;
};

/// `resume` is null, or the archive to read its checkpoint from.
std::unique_ptr<SeriesSink> series_sink(const SinkContext& c, Archive* resume);

}  // namespace faba
