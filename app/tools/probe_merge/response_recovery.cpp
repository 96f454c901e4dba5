#include "app/tools/probe_merge/response_recovery.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <random>

#include "catchlight/color.hpp"
#include "catchlight/error.hpp"
#include "catchlight/util/text.hpp"

namespace catchlight::app {
namespace {

constexpr int kTerms = 6, kAnchorCode = 128;
using Terms = cv::Vec<double, kTerms>;

double srgb_log(int code) {
  return std::log(linear_from_srgb(std::max(code, 1) / 255.0) / linear_from_srgb(kAnchorCode / 255.0));
}

/// What is added to sRGB's logarithm, 0 at the anchor.
Terms terms_of(int code) {
  const double t = (code - kAnchorCode) / 255.0;
  return {srgb_log(code), std::log((code + 0.5) / (kAnchorCode + 0.5)), t, t * t, t * t * t, t * t * t * t};
}

/// Debevec's hat, 0 where codes clip.
double trust(int code) {
  constexpr int kEnd = 4;
  return std::max(0, std::min(code, 255 - code) - kEnd);
}

/// Whether the pixels around are nearly as this one in every photograph: there a camera that moved by a pixel does no harm.
bool is_flat(const Bracket& bracket, const cv::Point& at) {
  constexpr int kMaxSpread = 10;
  for (const Photograph& photograph : bracket) {
    int low = 255, high = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int green = photograph.codes.at<cv::Vec3b>(at.y + dy, at.x + dx)[1];
        low = std::min(low, green);
        high = std::max(high, green);
      }
    if (high - low > kMaxSpread) return false;
  }
  return true;
}

/// Flat pixels, chosen so that all codes occur about as often: most of a picture is of few codes, and a curve is only known
/// where there are some.
std::vector<cv::Point> sample_pixels(const Bracket& bracket) {
  constexpr int kTries = 200000, kCodesPerBin = 8, kMaxPerBin = 60;
  const cv::Size size = bracket.front().codes.size();
  if (size.width < 3 || size.height < 3) return {};
  std::vector<std::array<int, 256 / kCodesPerBin>> counts(bracket.size());
  std::vector<cv::Point> samples;
  std::mt19937 random(1);
  for (int i = 0; i < kTries; ++i) {
    const int x = 1 + static_cast<int>(random() % (size.width - 2)), y = 1 + static_cast<int>(random() % (size.height - 2));
    const auto bin = [&](std::size_t k) -> int& { return counts[k][bracket[k].codes.at<cv::Vec3b>(y, x)[1] / kCodesPerBin]; };
    bool is_wanted = false;
    for (std::size_t k = 0; k < bracket.size(); ++k)
      is_wanted = is_wanted || (trust(bracket[k].codes.at<cv::Vec3b>(y, x)[1]) > 0 && bin(k) < kMaxPerBin);
    if (!is_wanted || !is_flat(bracket, {x, y})) continue;
    for (std::size_t k = 0; k < bracket.size(); ++k) ++bin(k);
    samples.emplace_back(x, y);
  }
  return samples;
}

/// What one pixel of one photograph demands: trust · (log light + terms · unknowns - log exposure - log radiance) = 0.
struct Equation {
  double trust, constant;
  Terms terms;
};

/// A pixel's equations less their trusted mean, which takes its unknown radiance out. Empty where fewer than two say anything.
std::vector<Equation> equations_of(const Bracket& bracket, const cv::Point& at, int channel) {
  std::vector<Equation> equations;
  Equation mean{0, 0, {}};
  for (const Photograph& photograph : bracket) {
    const int code = photograph.codes.at<cv::Vec3b>(at)[2 - channel];
    const double weight = trust(code);
    if (weight == 0) continue;
    equations.push_back({weight, srgb_log(code) - std::log(photograph.exposure_s), terms_of(code)});
    mean.trust += weight;
    mean.constant += weight * equations.back().constant;
    mean.terms += weight * equations.back().terms;
  }
  if (equations.size() < 2) return {};
  for (Equation& equation : equations) {
    equation.constant -= mean.constant / mean.trust;
    equation.terms -= mean.terms / mean.trust;
  }
  return equations;
}

struct Fit {
  Terms unknowns;
  double rms_ev = 0;
  std::size_t equations = 0;
};

Fit fit_channel(const Bracket& bracket, const std::vector<cv::Point>& samples, int channel) {
  std::vector<Equation> equations;
  for (const cv::Point& at : samples)
    for (const Equation& equation : equations_of(bracket, at, channel)) equations.push_back(equation);
  constexpr double kTowardsSrgb = 1e-4;  ///< share of the weight; what no photograph tells stays as sRGB has it
  cv::Matx<double, kTerms, kTerms> normal = cv::Matx<double, kTerms, kTerms>::zeros();
  Terms right = Terms::all(0);
  double weights = 1e-30;
  for (const Equation& equation : equations) {
    const double weight = equation.trust * equation.trust;
    normal += weight * (equation.terms * equation.terms.t());
    right -= weight * equation.constant * equation.terms;
    weights += weight;
  }
  normal += kTowardsSrgb * weights * cv::Matx<double, kTerms, kTerms>::eye();
  Fit fit{normal.solve(right, cv::DECOMP_CHOLESKY), 0, equations.size()};
  double squares = 0;
  for (const Equation& equation : equations)
    squares += std::pow(equation.trust * (equation.constant + equation.terms.dot(fit.unknowns)), 2);
  fit.rms_ev = std::sqrt(squares / weights) / std::log(2);
  return fit;
}

[[noreturn]] void refuse(const Bracket& bracket, const std::string& why) {
  throw Error(bracket.front().path + " and the others of its bracket do not tell the camera's response: " + why +
              ". Are the exposure times right, and did neither camera nor ball move? --response srgb does without");
}

}  // namespace

LightOfCodes known_response(TransferFunction transfer, int max_code) {
  LightOfCodes curves;
  for (int code = 0; code <= max_code; ++code)
    for (auto& curve : curves) curve.push_back(linear_from_code(transfer, static_cast<double>(code) / max_code));
  return curves;
}

LightOfCodes recover_response(const Bracket& bracket) {
  constexpr std::size_t kMinEquations = 100;
  constexpr double kMaxEv = 0.25;
  const std::vector<cv::Point> samples = sample_pixels(bracket);
  LightOfCodes curves;
  for (int c = 0; c < 3; ++c) {
    const Fit fit = fit_channel(bracket, samples, c);
    if (fit.equations < kMinEquations) refuse(bracket, "hardly a pixel is neither black nor white in two of them");
    if (fit.rms_ev > kMaxEv) refuse(bracket, "they disagree by " + fixed_text(fit.rms_ev, 2) + " EV on average");
    for (int code = 0; code < 256; ++code) {
      curves[c].push_back(code == 0 ? 0 : std::exp(srgb_log(code) + terms_of(code).dot(fit.unknowns)));
      if (code > 0 && curves[c][code] < curves[c][code - 1]) refuse(bracket, "light would fall where codes rise");
    }
  }
  return curves;
}

}  // namespace catchlight::app
