#include "io/png_file.h"

#include <fmt/format.h>
#include <png.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

#include "core/error.h"

namespace tsubu::io {

namespace {

constexpr std::size_t longText = 512;  // bytes; longer texts are compressed

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what, std::string_view reason) {
  throw Error(ErrorKind::files, {{{path.string(), 0, 0}, fmt::format("The picture cannot be {}: {}.", what, reason), {}}});
}

void close(std::FILE* file) { std::fclose(file); }
using File = std::unique_ptr<std::FILE, decltype(&close)>;

/// What libpng reads and writes, in memory: then errors of files are ours to tell, and no destructor stands in the way of its longjmp.
struct Bytes {
  std::vector<std::uint8_t> data;
  std::size_t at = 0;
  char message[256] = "";
};

void onError(png_structp png, png_const_charp message) {
  auto* bytes = static_cast<Bytes*>(png_get_error_ptr(png));
  std::snprintf(bytes->message, sizeof bytes->message, "%s", message);
  std::longjmp(png_jmpbuf(png), 1);
}

void onWarning(png_structp, png_const_charp) {}

void onWrite(png_structp png, png_bytep data, std::size_t size) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  bytes->data.insert(bytes->data.end(), data, data + size);
}

void onRead(png_structp png, png_bytep data, std::size_t size) {
  auto* bytes = static_cast<Bytes*>(png_get_io_ptr(png));
  if (size > bytes->data.size() - bytes->at) png_error(png, "the file ends too early");
  std::memcpy(data, &bytes->data[bytes->at], size);
  bytes->at += size;
}

/// The texts as libpng wants them; they point into `text`.
std::vector<png_text> textChunks(const std::filesystem::path& path, const PngText& text) {
  std::vector<png_text> chunks;
  for (const auto& [key, value] : text) {
    const bool printable = std::all_of(key.begin(), key.end(), [](char c) { return c >= ' ' && c <= '~'; });
    if (key.empty() || key.size() > 79 || !printable || key.front() == ' ' || key.back() == ' ') {
      fail(path, "written", fmt::format("\"{}\" is not a keyword for PNG text (1 to 79 printable characters)", key));
    }
    const bool ascii = std::all_of(value.begin(), value.end(), [](char c) { return (c >= ' ' && c <= '~') || c == '\n'; });
    png_text chunk{};
    chunk.key = const_cast<char*>(key.c_str());
    chunk.text = const_cast<char*>(value.c_str());
    chunk.lang = const_cast<char*>("");
    chunk.lang_key = const_cast<char*>("");
    if (value.size() > longText) {
      chunk.compression = PNG_ITXT_COMPRESSION_zTXt;
    } else {
      chunk.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    }
    if (chunk.compression >= PNG_ITXT_COMPRESSION_NONE) {
      chunk.itxt_length = value.size();
    } else {
      chunk.text_length = value.size();
    }
    chunks.push_back(chunk);
  }
  return chunks;
}

/// False when libpng complains, with its words in bytes.message. Nothing in here has a destructor.
bool encode(png_structp png, png_infop info, const Image& image, const std::vector<png_text>& text, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  const auto width = static_cast<png_uint_32>(image.width), height = static_cast<png_uint_32>(image.height);
  png_set_IHDR(png, info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  // Frames are written once and read once: one filter and the lightest compression are four times faster and a sixth larger.
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  if (!text.empty()) png_set_text(png, info, text.data(), static_cast<int>(text.size()));
  png_write_info(png, info);
  png_write_image(png, rows);
  png_write_end(png, info);
  return true;
}

/// Sets width and height; false when libpng complains.
bool decodeHeader(png_structp png, png_infop info, int& width, int& height) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_info(png, info);
  png_set_expand(png);
  png_set_strip_16(png);
  png_set_strip_alpha(png);
  png_set_gray_to_rgb(png);
  png_read_update_info(png, info);
  width = static_cast<int>(png_get_image_width(png, info));
  height = static_cast<int>(png_get_image_height(png, info));
  if (png_get_rowbytes(png, info) != 3 * static_cast<std::size_t>(width)) png_error(png, "its pixels are of an unknown kind");
  return true;
}

bool decodePixels(png_structp png, png_infop info, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png))) return false;
  png_read_image(png, rows);
  png_read_end(png, info);
  return true;
}

std::vector<png_bytep> rowsOf(Image& image) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y) rows.push_back(image.pixel(0, y));
  return rows;
}

std::vector<std::uint8_t> encoded(const std::filesystem::path& path, const Image& image, const PngText& text) {
  const std::size_t size = static_cast<std::size_t>(std::max(image.width, 0)) * static_cast<std::size_t>(std::max(image.height, 0)) * 3;
  if (size == 0 || image.rgb.size() != size) fail(path, "written", "it has no pixels, or not as many as its size says");
  const std::vector<png_text> chunks = textChunks(path, text);
  std::vector<png_bytep> rows = rowsOf(const_cast<Image&>(image));  // libpng only reads them
  Bytes bytes;
  bytes.data.reserve(size / 2);
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &bytes, onError, onWarning);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, onWrite, nullptr);
  const bool good = encode(png, info, image, chunks, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!good) fail(path, "written", bytes.message);
  return std::move(bytes.data);
}

}  // namespace

void writePng(const std::filesystem::path& path, const Image& image, const PngText& text) {
  const std::vector<std::uint8_t> bytes = encoded(path, image, text);
  std::filesystem::path partial = path;
  partial += fmt::format(".{}.part", ::getpid());
  {
    const File file(std::fopen(partial.c_str(), "wb"), close);
    if (!file) fail(path, "written", std::strerror(errno));
    if (std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() || std::fflush(file.get()) != 0) {
      const int reason = errno;
      std::remove(partial.c_str());
      fail(path, "written", std::strerror(reason));
    }
  }
  std::error_code problem;
  std::filesystem::rename(partial, path, problem);
  if (problem) {
    std::remove(partial.c_str());
    fail(path, "written", problem.message());
  }
}

PngPicture readPng(const std::filesystem::path& path) {
  Bytes bytes;
  {
    const File file(std::fopen(path.c_str(), "rb"), close);
    if (!file) fail(path, "read", std::strerror(errno));
    std::uint8_t block[65536];
    std::size_t got;
    while ((got = std::fread(block, 1, sizeof block, file.get())) > 0) bytes.data.insert(bytes.data.end(), block, block + got);
    if (std::ferror(file.get())) fail(path, "read", std::strerror(errno));
  }
  if (bytes.data.size() < 8 || png_sig_cmp(bytes.data.data(), 0, 8) != 0) fail(path, "read", "it is not a PNG file");

  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &bytes, onError, onWarning);
  png_infop info = png_create_info_struct(png);
  png_set_read_fn(png, &bytes, onRead);
  PngPicture picture;
  int width = 0, height = 0;
  bool good = decodeHeader(png, info, width, height);
  if (good) {
    picture.image = Image(width, height);
    std::vector<png_bytep> rows = rowsOf(picture.image);
    good = decodePixels(png, info, rows.data());
  }
  if (good) {
    png_textp texts = nullptr;
    const int count = png_get_text(png, info, &texts, nullptr);
    for (int k = 0; k < count; ++k) picture.text[texts[k].key] = texts[k].text;
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (!good) fail(path, "read", bytes.message);
  return picture;
}

}  // namespace tsubu::io
