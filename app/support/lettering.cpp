#include "app/support/lettering.hpp"

#include <algorithm>
#include <array>
#include <opencv2/imgproc.hpp>

#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr char kFirst = ' ', kLast = '~';
constexpr double kCapital = 7, kBaseline = 2;  ///< in the glyphs' units: capitals reach from 2 to 9, small letters to 7
constexpr double kGap = 2;                     ///< between two letters
constexpr double kSpace = 2;
constexpr double kDot = 0.5;  ///< height of a dot: a line that short

/// For each character from the space on its lines, apart by spaces: points as two digits, x and y upward from the lowest
/// descender. A line after ~ is rounded: its inner points only pull. A point alone is a dot.
constexpr std::array<const char*, kLast - kFirst + 1> kGlyphs{
    "",                              // space
    "0904 02",                       // !
    "0907 2927",                     // "
    "1218 3238 0646 0444",           // #
    "~3637070534320203 2921",        // $
    "0249 0809191808 3233434232",    // %
    "~420738292918 ~180402224245",   // &
    "0907",                          // '
    "~29070421",                     // (
    "~09272401",                     // )
    "2824 0745 0547",                // *
    "0545 2723",                     // +
    "1200",                          // ,
    "0535",                          // -
    "02",                            // .
    "0149",                          // /
    "~050949420205",                 // 0
    "072922",                        // 1
    "~07094946 460242",              // 2
    "~0809494626 ~2646420203",       // 3
    "32390444",                      // 4
    "490906 ~0647420203",            // 5
    "~4849090242460604",             // 6
    "094912",                        // 7
    "~264649090626 ~264642020626",   // 8
    "~0302424909054547",             // 9
    "06 02",                         // :
    "16 1200",                       // ;
    "480542",                        // <
    "0646 0444",                     // =
    "084502",                        // >
    "~070949462624 22",              // ?
    "~363716133545 ~4549090242",     // @
    "022942 1535",                   // A
    "0902 ~09494606 ~06464202",      // B
    "~484909024243",                 // C
    "0902 ~09494202",                // D
    "49090242 0636",                 // E
    "490902 0636",                   // F
    "~484909024245 4525",            // G
    "0902 4942 0646",                // H
    "0902",                          // I
    "~39320204",                     // J
    "0902 4905 1642",                // K
    "090242",                        // L
    "0209254942",                    // M
    "02094249",                      // N
    "~050949420205",                 // O
    "0902 ~09494505",                // P
    "~050949420205 2442",            // Q
    "0902 ~09494505 2542",           // R
    "~4849090645420203",             // S
    "0949 2922",                     // T
    "~090502424549",                 // U
    "092249",                        // V
    "0912283249",                    // W
    "0942 4902",                     // X
    "092649 2622",                   // Y
    "09490242",                      // Z
    "29090121",                      // [
    "0941",                          // backslash
    "09292101",                      // ]
    "072927",                        // ^
    "0141",                          // _
    "0917",                          // `
    "~363707023233 3732",            // a
    "0902 ~060737320203",            // b
    "~363707023233",                 // c
    "3932 ~363707023233",            // d
    "0535 ~353707023233",            // e
    "~39191512 0727",                // f
    "~363707023233 ~37323000",       // g
    "0902 ~0507373432",              // h
    "0702 09",                       // i
    "~17121000 19",                  // j
    "0902 3704 1532",                // k
    "~09030212",                     // l
    "0702 ~0507272422 ~2527474442",  // m
    "0702 ~0507373432",              // n
    "~050737320205",                 // o
    "0700 ~060737320203",            // p
    "3730 ~363707023233",            // q
    "0702 ~050727",                  // r
    "~3637070534320203",             // s
    "~19141232 0727",                // t
    "~0704023234 3732",              // u
    "072247",                        // v
    "0712263247",                    // w
    "0732 3702",                     // x
    "0722 4710",                     // y
    "07370232",                      // z
    "~29190615 ~15041121",           // {
    "0900",                          // |
    "~09192614 ~15240101",           // }
    "~05174446",                     // ~
};
constexpr const char* kUnknown = "0209494202";

const char* glyph(char character) {
  return character < kFirst || character > kLast ? kUnknown : kGlyphs[static_cast<std::size_t>(character - kFirst)];
}

/// Cuts corners (Chaikin 1974); the ends stay.
PenLine rounded(PenLine line) {
  constexpr int kTimes = 3;
  for (int i = 0; i < kTimes; ++i) {
    PenLine finer{line.front()};
    for (std::size_t k = 1; k < line.size(); ++k) {
      const glm::dvec2 &from = line[k - 1], &to = line[k];
      if (k > 1) finer.push_back(glm::mix(from, to, 0.25));
      if (k + 1 < line.size()) finer.push_back(glm::mix(from, to, 0.75));
    }
    finer.push_back(line.back());
    line = std::move(finer);
  }
  return line;
}

/// In the glyph's units, y down from the baseline.
std::vector<PenLine> lines_of(const char* text) {
  std::vector<PenLine> lines;
  for (const std::string& word : split(text, ' ')) {
    PenLine line;
    for (std::size_t i = word.starts_with('~') ? 1 : 0; i + 1 < word.size(); i += 2)
      line.emplace_back(word[i] - '0', kBaseline - (word[i + 1] - '0'));
    if (line.size() == 1) line.push_back(line.front() - glm::dvec2(0, kDot));
    if (!line.empty()) lines.push_back(word.starts_with('~') ? rounded(std::move(line)) : std::move(line));
  }
  return lines;
}

double width_of(const std::vector<PenLine>& lines) {
  double width = lines.empty() ? kSpace : 0;
  for (const PenLine& line : lines)
    for (const glm::dvec2& point : line) width = std::max(width, point.x);
  return width;
}

}  // namespace

std::vector<PenLine> lettering(std::string_view text) {
  std::vector<PenLine> all;
  double x = 0;
  for (const char character : text) {
    std::vector<PenLine> lines = lines_of(glyph(character));
    const double width = width_of(lines);
    for (PenLine& line : lines) {
      for (glm::dvec2& point : line) point = (point + glm::dvec2(x, 0)) / kCapital;
      all.push_back(std::move(line));
    }
    x += width + kGap;
  }
  return all;
}

double lettering_width(std::string_view text) {
  double width = 0;
  for (const char character : text) width += width_of(lines_of(glyph(character))) + kGap;
  return std::max(0.0, width - kGap) / kCapital;
}

void write_text(cv::Mat& picture, const std::string& text, const glm::dvec2& baseline_px, double capital_px,
                const cv::Scalar& color, int thickness_px) {
  constexpr int kShift = 4;  // sixteenths of a pixel
  std::vector<std::vector<cv::Point>> lines;
  for (const PenLine& line : lettering(text)) {
    lines.emplace_back();
    for (const glm::dvec2& point : line) {
      const glm::dvec2 px = 16.0 * (baseline_px + capital_px * point);
      lines.back().emplace_back(cvRound(px.x), cvRound(px.y));
    }
  }
  cv::polylines(picture, lines, false, color, thickness_px, cv::LINE_AA, kShift);
}

}  // namespace catchlight::app
