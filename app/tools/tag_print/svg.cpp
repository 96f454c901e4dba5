#include "app/tools/tag_print/writers.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// A length as text, to 10 nm.
std::string fixed(double value) {
  return fixed_text(value, 5);
}

/// What is printed holds none of XML's special characters but these.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return result;
}

}  // namespace

std::string svg_text(const Page& page) {
  const std::string width = fixed(page.width_mm), height = fixed(page.height_mm);
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + width + "mm\" height=\"" + height +
                     "mm\" viewBox=\"0 0 " + width + ' ' + height + "\">\n<rect width=\"" + width + "\" height=\"" + height +
                     "\" fill=\"white\"/>\n";
  for (const ShapeMm& shape : page.shapes) {
    text += "<path d=\"";
    for (const RectangleMm& r : shape)
      text += 'M' + fixed(r.x) + ',' + fixed(r.y) + 'h' + fixed(r.width) + 'v' + fixed(r.height) + 'h' + fixed(-r.width) + "z\n";
    text += "\"/>\n";
  }
  text += "<path fill=\"none\" stroke=\"black\" stroke-linecap=\"round\" stroke-linejoin=\"round\" stroke-width=\"" +
          fixed(kPenMm) + "\" d=\"";
  for (const PenLine& line : pen_lines(page)) {
    for (std::size_t i = 0; i < line.size(); ++i) text += (i == 0 ? 'M' : 'L') + fixed(line[i].x) + ',' + fixed(line[i].y);
    text += '\n';
  }
  text += "\"/>\n<desc>";
  for (const TextMm& line : page.texts) text += escaped(line.text) + '\n';
  return text + "</desc>\n</svg>\n";
}

}  // namespace catchlight::app
