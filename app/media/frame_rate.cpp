#include "app/media/frame_rate.hpp"

#include <cmath>

#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

/// NTSC's rates are a thousandth lower than they are called, and written with two or three digits.
double exact(double rate) {
  constexpr double kNtsc = 1000.0 / 1001;
  for (const double whole : {24.0, 30.0, 48.0, 60.0, 120.0})
    if (std::abs(rate - whole * kNtsc) < 0.005) return whole * kNtsc;
  return rate;
}

}  // namespace

double frame_rate_from_text(const std::string& text) {
  const std::vector<std::string> terms = split(text, '/');
  const auto above = real_from_text(terms[0]), below = terms.size() == 2 ? real_from_text(terms[1]) : 1.0;
  const double rate = above && below && terms.size() <= 2 ? *above / *below : 0;
  constexpr double kMaxRate = 10'000;
  if (!(rate > 0 && rate <= kMaxRate))
    throw UsageError("--fps " + text + ": expected frames a second, such as 25, 23.976 or 24000/1001");
  return terms.size() == 2 ? rate : exact(rate);
}

}  // namespace catchlight::app
