#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lodestar {

/// The image of a map: gray values as map_server defines them, top row first.
struct MapImage {
  int width_px = 0;
  int height_px = 0;
  std::vector<std::uint8_t> gray;
  std::vector<bool> transparent;  ///< one for each pixel, or empty when none is
};

/// Reads PGM (P2, P5), PNG or BMP. Throws std::runtime_error with the reason.
MapImage read_map_image(const std::filesystem::path& file);

/// A binary PGM (P5) with 8 bits a pixel.
std::string pgm_text(const MapImage& image);

}  // namespace lodestar
