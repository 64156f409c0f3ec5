#pragma once
// Pictures as PNG files.

#include <filesystem>
#include <map>
#include <string>

#include "core/image.h"

namespace tsubu::io {

/// Words that travel in the file, by keyword (1 to 79 printable ASCII characters). UTF-8.
using PngText = std::map<std::string, std::string>;

struct PngPicture {
  Image image;
  PngText text;
};

/// Writes 8-bit RGB with the chunks sRGB and gAMA. Long texts are compressed. The file appears complete or not at all: it is written under
/// another name next to it and renamed. Throws Error(files) with the name and the reason.
void writePng(const std::filesystem::path& path, const Image& image, const PngText& text = {});

/// Reads any PNG as 8-bit RGB: palettes, grey and 16 bits are converted, transparency is dropped, colours are taken as they are.
/// Throws Error(files) with the name and the reason.
PngPicture readPng(const std::filesystem::path& path);

}  // namespace tsubu::io
