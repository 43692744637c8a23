#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/file.h"
#include "vision/image/image.h"

namespace faba {

/// How the metadata of a TIFF stack are written.
enum class TiffKind {
  ome,    ///< OME-XML: Bio-Formats, OMERO, Fiji, napari
  imagej  ///< as ImageJ writes it
};
/// The kind for the name of a file: ome for NAME.ome.tif and NAME.ome.tiff, imagej for other names that end
/// in .tif or .tiff; empty for other names.
std::optional<TiffKind> tiff_kind(const std::filesystem::path& file);

enum class TiffPixels { grey8, grey16, grey_float, colour };

/// Scale and times of a stack.
struct TiffScale {
  std::optional<double> um_per_px;  ///< empty: not known, no scale is written
  std::optional<double> frame_s;    ///< time between two frames; empty: not known
};

/// Writes pictures of one size as a TIFF stack, uncompressed. The pixels of all pages are consecutive, and
/// the directories follow them, so that number and length of the pages need not be known in advance: the file
/// is a BigTIFF if it does not fit into the 4 GB of a classic TIFF. The file has a temporary name until
/// finish() is called, and is removed otherwise.
class TiffWriter {
 public:
  /// `most_classic`: maximum length of a classic TIFF, bytes. Throws Error(internal) if the file cannot be
  /// written, as all functions do.
  TiffWriter(const std::filesystem::path& file, int width, int height, TiffPixels pixels,
             std::uint64_t most_classic = 0xFFFFFFFF);
  ~TiffWriter();
  TiffWriter(const TiffWriter&) = delete;
  TiffWriter& operator=(const TiffWriter&) = delete;

  /// Appends a page; its size and type of pixels must be those of the stack.
  void write(const Gray8& page) { append(page, TiffPixels::grey8); }
  void write(const Image<std::uint16_t>& page) { append(page, TiffPixels::grey16); }
  void write(const GrayF& page) { append(page, TiffPixels::grey_float); }
  void write(const RgbImage& page) { append(page, TiffPixels::colour); }

  std::uint64_t pages() const { return pages_; }
  /// Completes the file; at least one page was written. Returns whether it is a BigTIFF.
  bool finish(TiffKind kind, const TiffScale& scale);

 private:
  template <class Pixel>
  void append(const Image<Pixel>& page, TiffPixels pixels);
  void append_bytes(const void* bytes, std::uint64_t size);

  std::filesystem::path path_;
  OutputFile file_;
  int width_, height_;
  TiffPixels pixels_;
  std::uint64_t most_classic_, page_bytes_ = 0, pages_ = 0;
  bool complete_ = false;
};

}  // namespace faba
