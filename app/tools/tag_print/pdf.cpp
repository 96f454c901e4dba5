#include <cstdio>

#include "app/tools/tag_print/writers.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr double kPointsPerMm = 72 / 25.4;
constexpr double kCapitalsOfHelvetica = 0.72;  ///< share of the font's size

/// A length as text, to 10 nm.
std::string fixed(double value) {
  return fixed_text(value, 5);
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

/// Millimetres from the bottom left: PDF's y is up.
std::string page_content(const Page& page) {
  const std::string scale = fixed_text(kPointsPerMm, 10);
  std::string content = scale + " 0 0 " + scale + " 0 0 cm\n0 g\n";
  for (const ShapeMm& shape : page.shapes) {
    for (const RectangleMm& r : shape)
      content +=
          fixed(r.x) + ' ' + fixed(page.height_mm - r.y - r.height) + ' ' + fixed(r.width) + ' ' + fixed(r.height) + " re\n";
    content += "f\n";
  }
  content += fixed(kPenMm) + " w 1 J 1 j\n";
  for (const PenLine& line : pen_lines(page)) {
    for (std::size_t i = 0; i < line.size(); ++i)
      content += fixed(line[i].x) + ' ' + fixed(page.height_mm - line[i].y) + (i == 0 ? " m\n" : " l\n");
    content += "S\n";
  }
  // What the pen has written once more as text that is not seen, for those who search or copy.
  content += "BT\n3 Tr\n/F1 " + fixed(kCapitalMm / kCapitalsOfHelvetica) + " Tf\n";
  for (const TextMm& text : page.texts)
    content +=
        "1 0 0 1 " + fixed(text.x) + ' ' + fixed(page.height_mm - text.baseline_y) + " Tm (" + escaped(text.text) + ") Tj\n";
  return content + "ET\n";
}

/// Objects in the order of their numbers, from 1, with the table of where each begins.
class PdfFile {
 public:
  void add(const std::string& body) {
    offsets_.push_back(text_.size());
    text_ += std::to_string(offsets_.size()) + " 0 obj\n" + body + "\nendobj\n";
  }

  std::string finished() const {
    const std::string size = std::to_string(offsets_.size() + 1);
    std::string table = "xref\n0 " + size + "\n0000000000 65535 f \n";
    for (const std::size_t offset : offsets_) {
      char line[24];
      std::snprintf(line, sizeof line, "%010zu 00000 n \n", offset);
      table += line;
    }
    return text_ + table + "trailer\n<< /Size " + size + " /Root 1 0 R >>\nstartxref\n" + std::to_string(text_.size()) +
           "\n%%EOF\n";
  }

 private:
  std::string text_ = "%PDF-1.4\n";
  std::vector<std::size_t> offsets_;
};

}  // namespace

std::string pdf_text(const std::vector<Page>& pages) {
  constexpr std::size_t kFirstPage = 4;  // then a page and its content in turn
  const auto page_number = [](std::size_t index) { return kFirstPage + 2 * index; };
  PdfFile file;
  file.add("<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>");
  std::string kids;
  for (std::size_t i = 0; i < pages.size(); ++i) kids += std::to_string(page_number(i)) + " 0 R ";
  file.add("<< /Type /Pages /Kids [ " + kids + "] /Count " + std::to_string(pages.size()) + " >>");
  file.add("<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>");
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const std::string content = page_content(pages[i]);
    file.add("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + fixed(pages[i].width_mm * kPointsPerMm) + ' ' +
             fixed(pages[i].height_mm * kPointsPerMm) + "] /Resources << /Font << /F1 3 0 R >> >> /Contents " +
             std::to_string(page_number(i) + 1) + " 0 R >>");
    file.add("<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream");
  }
  return file.finished();
}

}  // namespace catchlight::app
