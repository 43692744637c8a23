#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "vision/flow/flow.h"

namespace faba {

/// Writes a flow in the Middlebury format (.flo): the tag 202021.25, width and height as 32-bit integers,
/// then u and v of each pixel, row by row, all little-endian 32-bit. Non-finite values are written as
/// unknown. Written to a temporary file that is renamed when complete. Throws Error(internal).
void write_flo(const std::filesystem::path& path, const Flow& flow);
/// Reads a .flo file; unknown values (above 1e9) become NaN. Throws Error(input, path).
Flow read_flo(const std::filesystem::path& path);

/// Metadata of a series of flows.
struct FlowInfo {
  int width = 0, height = 0;        ///< px
  double fps = 0;                   ///< frames per second; 0: unknown
  std::optional<double> um_per_px;  ///< empty: unknown
  std::string method;               ///< flow part and its parameters, as JSON
  std::string source;               ///< video or pictures that the flow was computed from
};

/// Writes a series of flows to HDF5 (docs/formats/flow.md); the file is readable while it grows and after a
/// crash.
class FlowFileWriter {
 public:
  /// Creates `path`; an existing file is replaced. The flows are not compressed: their last digits are noise,
  /// and deflate saves less than a fifth. Throws Error(internal).
  FlowFileWriter(const std::filesystem::path& path, const FlowInfo& info);
  ~FlowFileWriter();
  /// Appends the flow between frames `frame` and `frame` + 1 at times t0_s and t1_s.
  void write(std::uint64_t frame, double t0_s, double t1_s, const Flow& flow);
  std::uint64_t size() const;  ///< number of flows written
  void sync();                 ///< syncs all data to disk
  /// Syncs and renames the file to `to`; writing may continue.
  void rename_complete(const std::filesystem::path& to);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads the HDF5 file of FlowFileWriter.
class FlowFileReader {
 public:
  /// Throws Error(input, path) when the file is not a flow file.
  explicit FlowFileReader(const std::filesystem::path& path);
  ~FlowFileReader();
  /// Whether the file has the HDF5 signature.
  static bool recognises(const std::filesystem::path& path);

  const FlowInfo& info() const;
  std::uint64_t size() const;  ///< number of flows
  void read(std::uint64_t index, std::uint64_t& frame, double& t0_s, double& t1_s, Flow& flow) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
