#pragma once
// Minimal encoders written byte by byte, so that the readers are tested against the file formats and not
// against the
// writers of the same libraries.

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace faba::media {

/// `value` in `count` bytes.
inline std::string bytes_of(std::uint64_t value, int count, bool big_endian) {
  std::string out;
  for (int i = 0; i < count; ++i) {
    const int shift = 8 * (big_endian ? count - 1 - i : i);
    out += static_cast<char>((value >> shift) & 0xFF);
  }
  return out;
}

/// Tags and pixels of one page of an uncompressed TIFF: `pixels` is all strips or tiles in order.
struct TiffPage {
  std::uint32_t width = 0, height = 0, bits = 8, samples = 1, format = 1, photometric = 1, planar = 1;
  std::uint32_t rows_per_strip = 0;  ///< 0: one strip; for tiles: tile height
  std::uint32_t tile_width = 0;      ///< tile width; 0: strips
  std::uint32_t subfile = 0;         ///< 1: reduced-resolution page
  std::string description{};
  double x_resolution = 0, y_resolution = 0;  ///< pixels per unit; 0: no tag
  std::string pixels{};
};

/// One field of a TIFF directory.
struct TiffEntry {
  std::uint32_t tag, type, count;
  std::string data;
};

class TiffWriter {
 public:
  explicit TiffWriter(bool big_endian) : big_endian_(big_endian) {
    file_ = big_endian ? std::string("MM\0*", 4) : std::string("II*\0", 4);
    link_ = file_.size();
    file_ += std::string(4, '\0');
  }
  void add(const TiffPage& page) {
    const std::size_t pixels_at = file_.size();
    file_ += page.pixels;
    append_directory(entries(page, pixels_at));
  }
  const std::string& file() const { return file_; }

 private:
  std::string bytes(std::uint64_t value, int count) const { return bytes_of(value, count, big_endian_); }
  TiffEntry number(std::uint32_t tag, std::uint32_t value) const { return {tag, 4, 1, bytes(value, 4)}; }
  TiffEntry list(std::uint32_t tag, const std::vector<std::uint32_t>& values, bool brief = false) const {
    TiffEntry entry{tag, brief ? 3U : 4U, static_cast<std::uint32_t>(values.size()), ""};
    for (const auto value : values) entry.data += bytes(value, brief ? 2 : 4);
    return entry;
  }
  TiffEntry ratio(std::uint32_t tag, double value) const {
    return {tag, 5, 1, bytes(std::uint64_t(value * 1e6), 4) + bytes(1000000, 4)};
  }
  std::vector<TiffEntry> entries(const TiffPage& page, std::size_t pixels_at) const;
  void append_directory(const std::vector<TiffEntry>& entries);

  bool big_endian_;
  std::string file_;
  std::size_t link_;  // position of the offset to the next page
};

inline std::vector<TiffEntry> TiffWriter::entries(const TiffPage& page, std::size_t pixels_at) const {
  const bool tiled = page.tile_width != 0;
  const std::uint32_t rows = page.rows_per_strip == 0 ? page.height : page.rows_per_strip;
  const std::uint32_t down = (page.height + rows - 1) / rows;
  const std::uint32_t across = tiled ? (page.width + page.tile_width - 1) / page.tile_width : 1;
  const std::uint32_t planes = page.planar == 2 ? page.samples : 1;
  const std::uint32_t row_bits =
      page.bits * (page.planar == 2 ? 1 : page.samples) * (tiled ? page.tile_width : page.width);
  std::vector<std::uint32_t> offsets, counts;
  for (std::uint32_t i = 0; i < planes * down * across; ++i) {
    const std::uint32_t top = (i / across) % down * rows;
    offsets.push_back(static_cast<std::uint32_t>(pixels_at));
    counts.push_back((row_bits + 7) / 8 * (tiled ? rows : std::min(rows, page.height - top)));
    pixels_at += counts.back();
  }
  std::vector<TiffEntry> all = {number(254, page.subfile),
                                number(256, page.width),
                                number(257, page.height),
                                list(258, std::vector<std::uint32_t>(page.samples, page.bits), true),
                                number(259, 1),
                                number(262, page.photometric)};
  if (!page.description.empty()) {
    const std::string text = page.description + '\0';
    all.push_back({270, 2, static_cast<std::uint32_t>(text.size()), text});
  }
  if (!tiled) all.push_back(list(273, offsets));
  all.push_back(number(277, page.samples));
  if (!tiled) all.insert(all.end(), {number(278, rows), list(279, counts)});
  if (page.x_resolution > 0) all.push_back(ratio(282, page.x_resolution));
  if (page.y_resolution > 0) all.push_back(ratio(283, page.y_resolution));
  all.push_back(number(284, page.planar));
  if (tiled) {
    all.insert(all.end(),
               {number(322, page.tile_width), number(323, rows), list(324, offsets), list(325, counts)});
  }
  all.push_back(list(339, std::vector<std::uint32_t>(page.samples, page.format), true));
  return all;
}

inline void TiffWriter::append_directory(const std::vector<TiffEntry>& entries) {
  std::string directory = bytes(entries.size(), 2), overflow;
  const std::size_t overflow_at = file_.size() + 2 + 12 * entries.size() + 4;
  for (const TiffEntry& entry : entries) {
    directory += bytes(entry.tag, 2) + bytes(entry.type, 2) + bytes(entry.count, 4);
    if (entry.data.size() <= 4) {
      directory += entry.data + std::string(4 - entry.data.size(), '\0');
    } else {
      directory += bytes(overflow_at + overflow.size(), 4);
      overflow += entry.data + std::string(entry.data.size() % 2, '\0');
    }
  }
  file_.replace(link_, 4, bytes(file_.size(), 4));
  link_ = file_.size() + directory.size();
  file_ += directory + std::string(4, '\0') + overflow;
}

/// A classic TIFF of `pages`, without compression.
inline std::string tiff_file(const std::vector<TiffPage>& pages, bool big_endian = false) {
  TiffWriter writer(big_endian);
  for (const TiffPage& page : pages) writer.add(page);
  return writer.file();
}

/// A PNG without compression; `rows` holds the samples in file order (16 bits: high byte first).
inline std::string png_file(int width, int height, int bits, bool colour, const std::string& rows) {
  const auto crc = [](const std::string& data) {
    std::uint32_t sum = 0xFFFFFFFFU;
    for (const char c : data) {
      sum ^= static_cast<std::uint8_t>(c);
      for (int k = 0; k < 8; ++k) sum = (sum >> 1) ^ ((sum & 1U) != 0 ? 0xEDB88320U : 0U);
    }
    return sum ^ 0xFFFFFFFFU;
  };
  const auto chunk = [&](const std::string& type, const std::string& data) {
    return bytes_of(data.size(), 4, true) + type + data + bytes_of(crc(type + data), 4, true);
  };
  const std::size_t row_bytes = rows.size() / static_cast<std::size_t>(height);
  std::string raw;
  for (std::size_t at = 0; at < rows.size(); at += row_bytes) raw += '\0' + rows.substr(at, row_bytes);
  std::uint32_t a = 1, b = 0;
  for (const char c : raw) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  std::string packed = "\x78\x01";
  for (std::size_t at = 0; at < raw.size(); at += 65535) {
    const std::string piece = raw.substr(at, 65535);
    packed += at + 65535 >= raw.size() ? '\1' : '\0';
    packed += bytes_of(piece.size(), 2, false) + bytes_of(~piece.size(), 2, false) + piece;
  }
  packed += bytes_of((b << 16) | a, 4, true);
  const std::string header = bytes_of(static_cast<std::uint64_t>(width), 4, true) +
                             bytes_of(static_cast<std::uint64_t>(height), 4, true) + static_cast<char>(bits) +
                             (colour ? '\2' : '\0') + std::string(3, '\0');
  return "\x89PNG\r\n\x1A\n" + chunk("IHDR", header) + chunk("IDAT", packed) + chunk("IEND", "");
}

/// A GIF of uniform grey frames with individual delays in 1/100 s.
inline std::string gif_file(int width, int height, const std::vector<std::pair<int, int>>& grey_and_delay) {
  const auto size = [&] {
    return bytes_of(static_cast<std::uint64_t>(width), 2, false) +
           bytes_of(static_cast<std::uint64_t>(height), 2, false);
  };
  std::string file = "GIF89a" + size() + "\xF6" + std::string(2, '\0');
  for (int i = 0; i < 128; ++i) file += std::string(3, static_cast<char>(2 * i));
  for (const auto& [grey, delay] : grey_and_delay) {
    file += std::string("\x21\xF9\x04\x04", 4) + bytes_of(static_cast<std::uint64_t>(delay), 2, false) +
            std::string(2, '\0');
    file += "," + std::string(4, '\0') + size() + '\0' + '\7';
    // A clear code (128) every 100 pixels keeps every code at 8 bits: no compression.
    std::string codes;
    for (int i = 0; i < width * height; ++i) {
      if (i % 100 == 0) codes += '\x80';
      codes += static_cast<char>(grey / 2);
    }
    codes += '\x81';
    for (std::size_t at = 0; at < codes.size(); at += 255) {
      const std::string piece = codes.substr(at, 255);
      file += static_cast<char>(piece.size()) + piece;
    }
    file += '\0';
  }
  return file + ";";
}

}  // namespace faba::media
