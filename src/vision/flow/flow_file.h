#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "vision/flow/flow.h"

namespace faba {

/// Writes a flow in the Middlebury format (.flo): the number 202021.25, width and height as 32-bit integers,
/// then u and v of every pixel in turn, row by row, all little-endian 32-bit. What is not finite is written
/// as unknown. Under a temporary name that is renamed when whole. Throws Error(internal).
void write_flo(const std::filesystem::path& path, const Flow& flow);
/// Reads it; unknown values (above 1e9) become NaN. Throws Error(input, path).
Flow read_flo(const std::filesystem::path& path);

/// What belongs to a series of flows beside them.
struct FlowInfo {
  int width = 0, height = 0;        ///< px
  double fps = 0;                   ///< frames per second as stated; 0: not stated
  std::optional<double> um_per_px;  ///< when known
  std::string method;               ///< flow part and its parameters, as JSON
  std::string source;               ///< what it was computed from
};

/// A series of flows in HDF5 (docs/formats/flow.md): readable while it grows and after a crash.
class FlowFileWriter {
 public:
  /// Makes `path`, replacing what is there. Throws Error(internal).
  FlowFileWriter(const std::filesystem::path& path, const FlowInfo& info, bool compress);
  ~FlowFileWriter();
  /// The flow between frames `frame` and `frame` + 1, taken at t0_s and t1_s.
  void write(std::uint64_t frame, double t0_s, double t1_s, const Flow& flow);
  std::uint64_t size() const;  ///< flows written
  void sync();                 ///< everything so far to the disk
  /// Gives the file its final name, all of it on the disk; writing may continue.
  void rename_complete(const std::filesystem::path& to);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads such a file, flow by flow.
class FlowFileReader {
 public:
  /// Throws Error(input, path) when it is no such file.
  explicit FlowFileReader(const std::filesystem::path& path);
  ~FlowFileReader();
  /// Whether a file begins as such files do: HDF5.
  static bool recognises(const std::filesystem::path& path);

  const FlowInfo& info() const;
  std::uint64_t size() const;  ///< flows
  void read(std::uint64_t index, std::uint64_t& frame, double& t0_s, double& t1_s, Flow& flow) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
