// What is printed, read back by parsers and detectors that know nothing of how it was laid out.
#include "app/tools/tag_print/writers.hpp"
#include "catchlight/camera.hpp"
#include "catchlight/error.hpp"
#include "catchlight/luma_view.hpp"
#include "catchlight/response.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tracking/camera/camera_file.hpp"
#include "tracking/detection/detector.hpp"
#include "tracking/detection/families.hpp"
#include "tracking/refinement/corner_refinement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <regex>
#include <sstream>

namespace catchlight::app {
namespace {

using ::testing::HasSubstr;
using tests::message_of;
using tracking::Detection;

TagGrid single(const std::string& family, int id, double size_m) {
  return {family, 1, 1, id, size_m, 0};
}

TagGrid board_of_12() {
  return {"tag36h11", 4, 3, 20, 0.04, 0.05};
}

/// Found by the detector, corners placed by their edges.
std::vector<Detection> detect(const cv::Mat1b& picture, const std::string& family) {
  // Ideal steps from pixel to pixel have no slope that an edge could be placed by.
  cv::Mat1b blurred;
  cv::GaussianBlur(picture, blurred, {}, 0.8);
  LumaView luma{blurred.data, blurred.cols, blurred.rows, static_cast<int>(blurred.step)};
  luma.transfer = TransferFunction::linear;
  std::vector<Detection> found = tracking::Detector(family, {}).detect(luma);
  for (Detection& tag : found) {
    const CameraModel plain = tracking::camera_from_field_of_view(picture.cols, picture.rows, 60);
    tag.corners_px = tracking::refine_corners(luma, plain, tag.corners_px, tracking::tag_layout(family, tag.id)).corners_px;
  }
  return found;
}

glm::dvec2 center(const Detection& tag) {
  return (tag.corners_px[0] + tag.corners_px[1] + tag.corners_px[2] + tag.corners_px[3]) / 4.0;
}

/// A fifth of what one pixel more or less on a side would do.
constexpr double kCornerPx = 0.1;

/// Upright, of that side, wherever it is.
void expect_square(const Detection& tag, double side_px) {
  const double h = side_px / 2;
  const std::array<glm::dvec2, 4> corners{{{-h, h}, {h, h}, {h, -h}, {-h, -h}}};  // tag order; y down
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(tag.corners_px[i].x - center(tag).x, corners[i].x, kCornerPx) << "corner " << i;
    EXPECT_NEAR(tag.corners_px[i].y - center(tag).y, corners[i].y, kCornerPx) << "corner " << i;
  }
}

cv::Mat1b decoded(const std::string& png) {
  const std::vector<std::uint8_t> bytes(png.begin(), png.end());
  return cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
}

// --- a reader for just such PDF files -------------------------------------------------------------------------------------

struct PdfPage {
  double width_mm = 0, height_mm = 0;
  std::vector<std::vector<cv::Rect2d>> shapes;  ///< mm, y up from the bottom of the page
  std::string content;
};

std::vector<PdfPage> read_pdf(const std::string& pdf) {
  constexpr double kMmPerPoint = 25.4 / 72;
  const std::regex page_object(
      "MediaBox \\[0 0 ([0-9.]+) ([0-9.]+)\\][^\n]*\nendobj\n[0-9]+ 0 obj\n<< /Length ([0-9]+) >>\nstream\n");
  std::vector<PdfPage> pages;
  for (std::sregex_iterator match(pdf.begin(), pdf.end(), page_object), end; match != end; ++match) {
    PdfPage page{std::stod((*match)[1]) * kMmPerPoint, std::stod((*match)[2]) * kMmPerPoint, {}, {}};
    const auto begin = static_cast<std::size_t>(match->position() + match->length());
    page.content = pdf.substr(begin, std::stoul((*match)[3]));
    EXPECT_EQ(pdf.substr(begin + page.content.size(), 9), "endstream");
    std::istringstream lines(page.content);
    double scale = 0;
    std::vector<cv::Rect2d> shape;
    for (std::string line; std::getline(lines, line);) {
      double a = 0, b = 0, c = 0, d = 0;
      if (line.ends_with(" cm")) scale = std::stod(line) * kMmPerPoint;
      if (std::sscanf(line.c_str(), "%lf %lf %lf %lf re", &a, &b, &c, &d) == 4 && line.ends_with(" re"))
        shape.emplace_back(a * scale, b * scale, c * scale, d * scale);
      if (line == "f") page.shapes.push_back(std::exchange(shape, {}));
    }
    pages.push_back(page);
  }
  return pages;
}

cv::Rect2d bounds(const std::vector<cv::Rect2d>& shape) {
  cv::Rect2d all = shape.at(0);
  for (const cv::Rect2d& r : shape) all |= r;
  return all;
}

/// The page at 10 pixels/mm; enough for cells of whole millimetres and tenths.
cv::Mat1b drawn(const PdfPage& page) {
  cv::Mat1b picture(cvRound(page.height_mm * 10), cvRound(page.width_mm * 10), std::uint8_t{255});
  for (const auto& shape : page.shapes)
    for (const cv::Rect2d& r : shape) {
      const int x = cvRound(r.x * 10), right = cvRound((r.x + r.width) * 10);
      const int y = cvRound((page.height_mm - r.y - r.height) * 10), bottom = cvRound((page.height_mm - r.y) * 10);
      picture(cv::Rect(x, y, right - x, bottom - y)) = 0;
    }
  return picture;
}

// --- PNG ------------------------------------------------------------------------------------------------------------------

class PrintOfEveryFamily : public ::testing::TestWithParam<std::string> {};

TEST_P(PrintOfEveryFamily, PngIsDetectedAtItsSize) {
  const PixelGrid pixels = on_pixels(single(GetParam(), 3, 0.0317), 110);
  const Page page = lay_out(pixels.grid, "fit", 1000.0 / pixels.pixels_per_m);
  const cv::Mat1b picture = decoded(png_bytes(page, pixels.pixels_per_m));
  const auto found = detect(picture, GetParam());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, 3);
  EXPECT_EQ(found[0].hamming, 0);
  expect_square(found[0], 0.0317 * pixels.pixels_per_m);
  EXPECT_NEAR(center(found[0]).x, (picture.cols - 1) / 2.0, 0.6);  // in the middle, moved to whole pixels
}

TEST_P(PrintOfEveryFamily, PdfIsDetectedAtItsSize) {
  const double size_m = 0.004 * tag_reach(GetParam()).cells_across;  // cells of 4 mm
  const std::vector<PdfPage> pages = read_pdf(pdf_text({lay_out(single(GetParam(), 5, size_m), "a4")}));
  ASSERT_EQ(pages.size(), 1u);
  const auto found = detect(drawn(pages[0]), GetParam());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, 5);
  expect_square(found[0], size_m * 10000);
}

TEST_P(PrintOfEveryFamily, ClosestTagsKeepOneWhiteCellBetweenThem) {
  const TagReach reach = tag_reach(GetParam());
  const double cell_m = 0.004, size_m = cell_m * reach.cells_across, least_m = cell_m * (2 * reach.ink_cells + 1);
  const TagGrid board{GetParam(), 2, 2, 0, size_m, least_m};
  EXPECT_NO_THROW(check_tag_grid(board));
  const PdfPage page = read_pdf(pdf_text({lay_out(board, "fit")})).at(0);
  ASSERT_GE(page.shapes.size(), 4u);
  const cv::Rect2d first = bounds(page.shapes[0]), right = bounds(page.shapes[1]), below = bounds(page.shapes[2]);
  EXPECT_GE(right.x - (first.x + first.width), 3.999);
  EXPECT_GE(first.y - (below.y + below.height), 3.999);
  const cv::Mat1b picture = drawn(page);
  EXPECT_EQ(detect(picture, GetParam()).size(), 4u);
  TagGrid closer = board;
  closer.spacing_m = least_m - 1e-6;
  EXPECT_THAT(message_of<UsageError>([&] { check_tag_grid(closer); }), HasSubstr(metres_text(least_m) + " or more"));
}

INSTANTIATE_TEST_SUITE_P(Library, PrintOfEveryFamily, ::testing::ValuesIn(tracking::tag_families()),
                         [](const auto& family) { return family.param; });

TEST(TagPng, StatesItsResolutionInAChunkThatReadersKnow) {
  // 72 dpi, as a great many files have it, with the checksum that they all carry.
  const std::string known("\0\0\0\x09pHYs\0\0\x0B\x13\0\0\x0B\x13\x01\0\x9A\x9C\x18", 21);
  const std::string png = png_bytes({30, 30, {}, {}}, 2835);
  EXPECT_EQ(png.find(known), 33u) << "right behind the header";
  EXPECT_EQ(decoded(png).size(), cv::Size(85, 85));
}

TEST(TagPng, CellsAreWholePixelsAndTheSizeStaysTrue) {
  const PixelGrid pixels = on_pixels(single("tag36h11", 0, 0.08), 300);
  EXPECT_EQ(pixels.pixels_per_cell, 118);
  EXPECT_EQ(pixels.pixels_per_m, 11800);
  EXPECT_NEAR(pixels.grid.size_m, 0.08, 1e-12);
  // 7 cells across of a size in inches: no resolution in whole pixels per metre fits, and the rest is told.
  const PixelGrid odd = on_pixels(single("tag25h9", 0, 0.0254), 300);
  EXPECT_NEAR(odd.grid.size_m * odd.pixels_per_m, 7.0 * odd.pixels_per_cell, 1e-9);
  EXPECT_NEAR(odd.grid.size_m, 0.0254, 0.0254 / (2 * odd.pixels_per_m) * 1.001);
}

TEST(TagPng, ABoardsTagsAreItsSpacingApart) {
  const PixelGrid pixels = on_pixels(board_of_12(), 150);
  const auto found =
      detect(decoded(png_bytes(lay_out(pixels.grid, "a4", 1000.0 / pixels.pixels_per_m), pixels.pixels_per_m)), "tag36h11");
  ASSERT_EQ(found.size(), 12u);
  for (int i = 0; i < 12; ++i) {
    EXPECT_EQ(found[i].id, 20 + i);
    expect_square(found[i], pixels.grid.size_m * pixels.pixels_per_m);
    const glm::dvec2 offset_m = (center(found[i]) - center(found[0])) / static_cast<double>(pixels.pixels_per_m);
    EXPECT_NEAR(offset_m.x, pixels.grid.spacing_m * (i % 4), kCornerPx / pixels.pixels_per_m);
    EXPECT_NEAR(offset_m.y, pixels.grid.spacing_m * (i / 4), kCornerPx / pixels.pixels_per_m);
  }
  EXPECT_NEAR(pixels.grid.spacing_m, 0.05, 0.5 / pixels.pixels_per_m);
}

TEST(TagPng, LessThanAPixelACellSaysHowManyDpiAreNeeded) {
  EXPECT_THAT(message_of<UsageError>([] { on_pixels(single("tag36h11", 0, 0.004), 20); }), HasSubstr("expected 51 or more"));
}

TEST(TagPng, APictureBeyondReasonIsRefused) {
  EXPECT_THAT(message_of<UsageError>([] { png_bytes({2000, 2000, {}, {}}, 40000); }), HasSubstr("80000 x 80000 pixels"));
}

// --- PDF ------------------------------------------------------------------------------------------------------------------

TEST(TagPdf, SizesAreExact) {
  const PdfPage page = read_pdf(pdf_text({lay_out(single("tag36h11", 0, 0.0801), "a4")})).at(0);
  constexpr double kHundredNanometres = 1e-4;
  EXPECT_NEAR(page.width_mm, 210, kHundredNanometres);
  EXPECT_NEAR(page.height_mm, 297, kHundredNanometres);
  const cv::Rect2d tag = bounds(page.shapes.at(0));  // the black border's outer edge is the size
  EXPECT_NEAR(tag.width, 80.1, kHundredNanometres);
  EXPECT_NEAR(tag.height, 80.1, kHundredNanometres);
  EXPECT_NEAR(tag.x + tag.width / 2, 105, kHundredNanometres);
}

TEST(TagPdf, RulerIs100MillimetresInTicksOfOne) {
  const PdfPage page = read_pdf(pdf_text({lay_out(single("tag36h11", 0, 0.08), "letter")})).at(0);
  const auto& ticks = page.shapes.back();
  ASSERT_EQ(ticks.size(), 101u);
  for (std::size_t mm = 0; mm < ticks.size(); ++mm) EXPECT_NEAR(ticks[mm].x - ticks[0].x, static_cast<double>(mm), 1e-4);
  EXPECT_THAT(page.content, HasSubstr("(print at 100 %; the ruler is 100 mm long) Tj"));
  EXPECT_THAT(page.content, HasSubstr("(tag36h11, id 0) Tj"));
  EXPECT_THAT(page.content, HasSubstr("(size_m = 0.08) Tj"));
}

TEST(TagPdf, RulerIsAsLongAsANarrowPageAllows) {
  const PdfPage page = read_pdf(pdf_text({lay_out(single("tag36h11", 0, 0.02), "fit")})).at(0);
  EXPECT_EQ(page.shapes.back().size(), 61u);
  EXPECT_LT(page.width_mm, 100);
}

TEST(TagPdf, TableOfObjectsPointsAtThem) {
  const std::string pdf = pdf_text({lay_out(single("tag36h11", 0, 0.08), "a4"), lay_out(single("tag36h11", 1, 0.08), "a4")});
  ASSERT_TRUE(pdf.starts_with("%PDF-1.4\n"));
  const std::size_t table = std::stoul(pdf.substr(pdf.find("startxref\n") + 10));
  ASSERT_EQ(pdf.substr(table, 9), "xref\n0 8\n");
  for (std::size_t number = 1; number < 8; ++number) {
    const std::string entry = pdf.substr(table + 9 + 20 * number, 20);
    EXPECT_TRUE(entry.ends_with(" 00000 n \n")) << entry;
    EXPECT_EQ(pdf.substr(std::stoul(entry), 8), std::to_string(number) + " 0 obj\n");
  }
  EXPECT_THAT(pdf, HasSubstr("/PrintScaling /None"));
}

TEST(TagPdf, EveryPageHasItsOwnTag) {
  std::vector<Page> pages;
  for (int id = 4; id < 7; ++id) pages.push_back(lay_out(single("tagStandard41h12", id, 0.05), "a4"));
  const std::vector<PdfPage> read = read_pdf(pdf_text(pages));
  ASSERT_EQ(read.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    const auto found = detect(drawn(read[i]), "tagStandard41h12");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].id, 4 + i);
  }
}

TEST(TagPdf, WhatFitsOnlyLengthwiseTurnsThePage) {
  const PdfPage page = read_pdf(pdf_text({lay_out({"tag36h11", 5, 2, 0, 0.04, 0.05}, "a4")})).at(0);
  EXPECT_NEAR(page.width_mm, 297, 1e-4);
  EXPECT_NEAR(page.height_mm, 210, 1e-4);
}

// --- the mark and the lettering -------------------------------------------------------------------------------------------

TEST(TagSheet, AnArrowShowsUpAndTheProbesDirectionsWithinThePaper) {
  for (const auto& [grid, paper] : {std::pair(single("tag36h11", 0, 0.02), "fit"),
                                    {single("tag36h11", 586, 0.08), "a4"},
                                    {board_of_12(), "fit"},
                                    {board_of_12(), "a3"}}) {
    const Page page = lay_out(grid, paper);
    ASSERT_EQ(page.lines.size(), 4u);
    const glm::dvec2 up = page.lines[0].back() - page.lines[0].front(), right = page.lines[2].back() - page.lines[2].front();
    EXPECT_GT(-up.y, 5);  // y is down
    EXPECT_EQ(up.x, 0);
    EXPECT_GT(right.x, 5);
    EXPECT_EQ(right.y, 0);
    for (const char* text : {"up +y (flat: probe -z)", "+x (probe +x)"})
      EXPECT_EQ(std::ranges::count_if(page.texts, [&](const TextMm& label) { return label.text == text; }), 1) << text;
    for (const PenLine& line : pen_lines(page))
      for (const glm::dvec2& point : line) {
        EXPECT_GE(point.x, 3);  // numbers stand on both sides of the ruler's ticks
        EXPECT_LE(point.x, page.width_mm - 3);
      }
    // Lettering stands before the mark, or beside its arrows.
    const PenLine& arrow = page.lines[0];
    for (const TextMm& text : page.texts) {
      const bool is_beside = text.baseline_y > arrow.back().y && text.baseline_y <= arrow.front().y + kCapitalMm;
      if (is_beside && text.x < arrow.front().x && !text.text.starts_with("print")) {
        EXPECT_LT(text.x + kCapitalMm * lettering_width(text.text), arrow.front().x) << text.text;
      }
    }
  }
}

/// Where the lines of the pen begin, in a text that holds each as `x y` behind or before a letter.
std::vector<glm::dvec2> beginnings(const std::string& text, const std::regex& pattern) {
  std::vector<glm::dvec2> points;
  for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
    points.emplace_back(std::stod((*match)[1]), std::stod((*match)[2]));
  return points;
}

TEST(TagSheet, LetteringIsTheSameInEveryFormat) {
  const Page page = lay_out(single("tag36h11", 3, 0.05), "a4");
  const std::vector<PenLine> lines = pen_lines(page);
  const auto pdf = beginnings(read_pdf(pdf_text({page})).at(0).content, std::regex("([0-9.]+) ([0-9.]+) m\n"));
  const std::string svg = svg_text(page);
  const auto drawn_svg = beginnings(svg.substr(svg.find("stroke-width")), std::regex("M([0-9.]+),([0-9.]+)L"));
  constexpr int kPixelsPerMm = 20;
  const cv::Mat1b png = decoded(png_bytes(page, 1000 * kPixelsPerMm));
  ASSERT_EQ(pdf.size(), lines.size());
  ASSERT_EQ(drawn_svg.size(), lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const glm::dvec2 begin = lines[i].front();
    EXPECT_NEAR(pdf[i].x, begin.x, 1e-5);
    EXPECT_NEAR(page.height_mm - pdf[i].y, begin.y, 1e-5);
    EXPECT_NEAR(drawn_svg[i].x, begin.x, 1e-5);
    EXPECT_NEAR(drawn_svg[i].y, begin.y, 1e-5);
    EXPECT_LT(png(static_cast<int>(begin.y * kPixelsPerMm), static_cast<int>(begin.x * kPixelsPerMm)), 128);
  }
}

// --- SVG ------------------------------------------------------------------------------------------------------------------

TEST(TagSvg, UserUnitIsTheMillimetre) {
  const std::string svg = svg_text(lay_out(single("tag36h11", 0, 0.08), "letter"));
  EXPECT_THAT(svg, HasSubstr("width=\"215.90000mm\" height=\"279.40000mm\" viewBox=\"0 0 215.90000 279.40000\""));
  // The border's top side is one run of 80 mm.
  EXPECT_THAT(svg, ::testing::ContainsRegex("h80\\.00000v10\\.00000h-80\\.00000z"));
}

TEST(TagSvg, DrawnByOthersItIsDetectedAtItsSize) {
  const tests::TemporaryFolder folder;
  const std::string svg = folder.write("tag.svg", svg_text(lay_out(single("tagStandard41h12", 11, 0.06), "a4")));
  if (std::system(("ffmpeg -v quiet -nostdin -i " + svg + " " + folder.path("tag.png")).c_str()) != 0)
    GTEST_SKIP() << "this ffmpeg draws no SVG";
  const cv::Mat1b picture = cv::imread(folder.path("tag.png"), cv::IMREAD_GRAYSCALE);
  const auto found = detect(picture, "tagStandard41h12");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].id, 11);
  expect_square(found[0], 0.06 * picture.cols / 0.210);  // at whatever resolution; the page is 210 mm wide
}

// --- what cannot be printed -------------------------------------------------------------------------------------------------

TEST(TagSheet, ATagTooLargeForThePaperIsToldTheLargestSize) {
  const auto message = message_of<UsageError>([] { lay_out(single("tag36h11", 0, 0.3), "a4"); });
  EXPECT_THAT(message, HasSubstr("375 x 375 mm, which a4 has no room for"));
  EXPECT_THAT(message, HasSubstr("up to --size-m 0.16"));
  EXPECT_NO_THROW(lay_out(single("tag36h11", 0, 0.16), "a4"));
  EXPECT_THROW(lay_out(single("tag36h11", 0, 0.161), "a4"), UsageError);
}

TEST(TagSheet, ABoardTooLargeForThePaperIsToldTheLargestBoard) {
  TagGrid grid{"tag36h11", 10, 8, 0, 0.04, 0.05};
  EXPECT_THAT(message_of<UsageError>([&] { lay_out(grid, "a4"); }), HasSubstr("a board of 4x5 fits"));
  grid.columns = 4;
  grid.rows = 5;
  EXPECT_NO_THROW(lay_out(grid, "a4"));
}

TEST(TagSheet, UnknownPaperNamesThoseThereAre) {
  EXPECT_THAT(message_of<UsageError>([] { lay_out(single("tag36h11", 0, 0.08), "a5"); }),
              HasSubstr("\"a4\", \"a3\", \"letter\" or \"fit\""));
}

TEST(TagGridCheck, IdsBeyondTheFamilyAndSizesThatAreNoneAreRefused) {
  EXPECT_THAT(message_of<Error>([] { check_tag_grid({"tag16h5", 6, 6, 0, 0.02, 0.03}); }), HasSubstr("0 to 29"));
  EXPECT_THAT(message_of<Error>([] { check_tag_grid(single("tag99h9", 0, 0.08)); }), HasSubstr("tag36h11"));
  for (const double size_m : {0.0, -1.0, 1e9, std::nan("")})
    EXPECT_THAT(message_of<UsageError>([&] { check_tag_grid(single("tag36h11", 0, size_m)); }), HasSubstr("--size-m is "));
}

TEST(TagGridCheck, ColumnsAndRowsAreTwoNumbers) {
  EXPECT_EQ(columns_and_rows("4x3", "--board"), glm::ivec2(4, 3));
  for (const char* text : {"", "4", "4x", "x3", "0x3", "4x-3", "4x3x2", "4*3", "101x1", "99999999999999999999x1"})
    EXPECT_THAT(message_of<UsageError>([&] { columns_and_rows(text, "--board"); }), HasSubstr("--board is ")) << text;
}

TEST(TagSceneToml, DescribesTheBoardFromItsFirstTag) {
  EXPECT_EQ(scene_toml({"tag25h9", 2, 2, 7, 0.04, 0.05}),
            "[tag]\nfamily = \"tag25h9\"\nid = 7\nsize_m = 0.04\n"
            "\n[[tag.bundle]]\nid = 8\ntag_from_this = { translation_m = [0.05, 0, 0] }\n"
            "\n[[tag.bundle]]\nid = 9\ntag_from_this = { translation_m = [0, -0.05, 0] }\n"
            "\n[[tag.bundle]]\nid = 10\ntag_from_this = { translation_m = [0.05, -0.05, 0] }\n");
}

}  // namespace
}  // namespace catchlight::app
