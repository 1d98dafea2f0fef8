#include "maps/picture.hpp"

#include <algorithm>
#include <filesystem>
#include <gmock/gmock.h>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <span>
#include <vector>

// OpenCV writes and reads the same formats by code that is not ours.
namespace lodestar {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ::testing::HasSubstr;

/// Blobs, a gradient and noise, with one, three or four channels.
cv::Mat picture_of(int type, int width_px = 37, int height_px = 23) {
  cv::Mat picture(height_px, width_px, type);
  cv::RNG random(7);
  random.fill(picture, cv::RNG::UNIFORM, 0, CV_MAT_DEPTH(type) == CV_16U ? 65536 : 256);
  return picture;
}

/// What a JPEG can hold without much loss.
cv::Mat smooth_picture(int type) {
  cv::Mat picture = picture_of(type, 40, 24);
  cv::GaussianBlur(picture, picture, {}, 4.0);
  return picture;
}

Bytes written(const char* ending, const cv::Mat& picture) {
  Bytes bytes;
  EXPECT_TRUE(cv::imencode(ending, picture, bytes)) << ending;
  return bytes;
}

int most_difference(const cv::Mat& a, const cv::Mat& b) {
  if (a.size() != b.size() || a.type() != b.type()) return 1 << 20;
  return static_cast<int>(cv::norm(a, b, cv::NORM_INF));
}

std::string reason_for(const Bytes& bytes) {
  try {
    decode_picture(bytes);
  } catch (const PictureError& error) {
    return error.what();
  }
  return "";
}

TEST(Picture, is_what_another_program_wrote_in_each_format_without_loss) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3}) {
    const cv::Mat picture = picture_of(type);
    EXPECT_EQ(most_difference(decode_picture(written(".png", picture)), picture), 0) << "png " << type;
  }
  for (const char* ending : {".bmp", ".tiff", ".ppm"}) {
    const cv::Mat picture = picture_of(CV_8UC3);
    EXPECT_EQ(most_difference(decode_picture(written(ending, picture)), picture), 0) << ending;
  }
  const cv::Mat gray = picture_of(CV_8UC1);
  for (const char* ending : {".png", ".bmp", ".tiff", ".pgm"})
    EXPECT_EQ(most_difference(decode_gray(written(ending, gray)), gray), 0) << ending;
}

TEST(Picture, loses_what_the_format_loses_and_no_more) {
  const cv::Mat colour = smooth_picture(CV_8UC3);
  const Bytes jpeg = written(".jpg", colour);
  EXPECT_LE(most_difference(decode_picture(jpeg), cv::imdecode(jpeg, cv::IMREAD_COLOR)), 1);
  EXPECT_EQ(most_difference(decode_gray(jpeg), cv::imdecode(jpeg, cv::IMREAD_GRAYSCALE)), 0);
  const Bytes webp = written(".webp", colour);
  EXPECT_EQ(most_difference(decode_picture(webp), cv::imdecode(webp, cv::IMREAD_COLOR)), 0);
}

TEST(Picture, becomes_gray_by_luma_with_16_bits_scaled_and_alpha_dropped) {
  const cv::Mat colour = picture_of(CV_8UC3);
  cv::Mat luma;
  cv::cvtColor(colour, luma, cv::COLOR_BGR2GRAY);
  EXPECT_EQ(most_difference(decode_gray(written(".png", colour)), luma), 0);
  cv::Mat clear;
  cv::cvtColor(colour, clear, cv::COLOR_BGR2BGRA);
  cv::insertChannel(cv::Mat::zeros(colour.size(), CV_8UC1), clear, 3);
  EXPECT_EQ(most_difference(decode_gray(written(".png", clear)), luma), 0);
  cv::Mat deep;
  luma.convertTo(deep, CV_16U, 257.0);
  for (const char* ending : {".png", ".pgm", ".tiff"})
    EXPECT_EQ(most_difference(decode_gray(written(ending, deep)), luma), 0) << ending;
}

/// A JPEG with a segment that says how the camera was held.
Bytes laid_down(const Bytes& jpeg, std::uint8_t orientation) {
  const Bytes exif{0xff, 0xe1, 0,    34,   'E', 'x', 'i', 'f', 0, 0, 'M', 'M',         0, 42, 0, 0, 0, 8,
                   0,    1,    0x01, 0x12, 0,   3,   0,   0,   0, 1, 0,   orientation, 0, 0,  0, 0, 0, 0};
  Bytes bytes{jpeg.at(0), jpeg.at(1)};
  std::ranges::copy(exif, std::back_inserter(bytes));
  std::ranges::copy(std::span(jpeg).subspan(2), std::back_inserter(bytes));
  return bytes;
}

TEST(Picture, is_turned_as_the_camera_was_held) {
  const Bytes upright = written(".jpg", smooth_picture(CV_8UC1));
  int others = 0;
  for (std::uint8_t orientation = 1; orientation <= 8; ++orientation) {
    const Bytes bytes = laid_down(upright, orientation);
    const cv::Mat seen = decode_gray(bytes);
    EXPECT_EQ(most_difference(seen, cv::imdecode(bytes, cv::IMREAD_GRAYSCALE)), 0) << int{orientation};
    others += most_difference(seen, decode_gray(upright)) != 0 ? 1 : 0;
  }
  EXPECT_EQ(others, 7);
}

TEST(Picture, is_read_by_another_program) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4}) {
    const cv::Mat picture = picture_of(type);
    const std::string png = png_bytes(picture);
    EXPECT_EQ(most_difference(cv::imdecode(Bytes(png.begin(), png.end()), cv::IMREAD_UNCHANGED), picture), 0);
  }
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat picture = smooth_picture(type);
    const std::string jpeg = jpeg_bytes(picture);
    EXPECT_LE(most_difference(cv::imdecode(Bytes(jpeg.begin(), jpeg.end()), cv::IMREAD_UNCHANGED), picture),
              12);
  }
  const cv::Mat part = picture_of(CV_8UC1)(cv::Rect(3, 2, 11, 9));  // rows that do not follow each other
  const std::string png = png_bytes(part);
  EXPECT_EQ(most_difference(decode_gray(Bytes(png.begin(), png.end())), part), 0);
}

TEST(Picture, that_is_cut_short_is_refused) {
  const cv::Mat picture = picture_of(CV_8UC3);
  for (const char* ending : {".png", ".bmp", ".tiff", ".ppm", ".webp"}) {
    const Bytes whole = written(ending, picture);
    EXPECT_EQ(reason_for(whole), "") << ending;
    for (const double share : {0.1, 0.5, 0.95}) {
      const auto end = whole.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(whole.size()));
      EXPECT_NE(reason_for(Bytes(whole.begin(), end)), "") << ending << " " << share;
    }
  }
}

TEST(Picture, says_why_it_is_none) {
  EXPECT_EQ(reason_for({}), "no image that can be decoded");
  EXPECT_EQ(reason_for({'h', 'e', 'l', 'l', 'o'}), "no image that can be decoded");
  EXPECT_EQ(reason_for(written(".tiff", cv::Mat::zeros(8, 8, CV_32FC1))), "floating-point pixels");
  const std::string huge = "P5\n30000 30000\n255\n";
  EXPECT_THAT(reason_for({huge.begin(), huge.end()}), HasSubstr("an image of 30000 x 30000 pixels"));
  const std::filesystem::path folder = std::filesystem::temp_directory_path();
  EXPECT_THROW(gray_picture_in(folder), PictureError);
  EXPECT_THROW(gray_picture_in(folder / "no such picture.png"), PictureError);
}

/// Nothing but a picture or a PictureError, whatever the bytes are: run by the sanitizers too.
TEST(Picture, with_any_bytes_changed_is_a_picture_or_refused) {
  std::mt19937 random(20261126);
  int refused = 0;
  int decoded = 0;
  for (const char* ending : {".png", ".jpg", ".bmp", ".tiff", ".ppm", ".webp", ".pgm"}) {
    const Bytes whole =
        written(ending, std::string(ending) == ".pgm" ? picture_of(CV_8UC1) : picture_of(CV_8UC3));
    for (int i = 0; i < 300; ++i) {
      Bytes bytes = whole;
      for (int change = 0; change < 3; ++change)
        bytes.at(random() % std::min<std::size_t>(bytes.size(), i % 2 == 0 ? 64 : bytes.size())) =
            static_cast<std::uint8_t>(random());
      reason_for(bytes).empty() ? ++decoded : ++refused;
    }
  }
  EXPECT_GT(decoded, 200);
  EXPECT_GT(refused, 200);
}

TEST(Picture, is_known_by_its_first_bytes) {
  for (const char* ending : {".png", ".jpg", ".bmp", ".tiff", ".ppm", ".webp", ".pgm"})
    EXPECT_TRUE(
        begins_picture(written(ending, picture_of(std::string(ending) == ".pgm" ? CV_8UC1 : CV_8UC3))));
  EXPECT_FALSE(begins_picture({}));
  EXPECT_FALSE(begins_picture(Bytes{'#', '!', '/', 'b'}));
}

}  // namespace
}  // namespace lodestar
