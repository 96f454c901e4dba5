// Adaptation of exposure "auto" filmed at four frame rates, as CSV on standard output: a lamp is switched on, goes out, flickers.
#include <cmath>
#include <cstdio>

#include "catchlight/tone_curve.hpp"
#include "render/tone/tone_adaptation.hpp"

namespace {

/// Stops of gain that the scene calls for; while it flickers, by 10 % from frame to frame.
double wanted_ev(double time_s, int frame) {
  if (time_s < 1) return 0;
  if (time_s < 3) return -3;
  if (time_s < 9) return 0;
  return frame % 2 ? 0.1375 : -0.1375;
}

}  // namespace

int main() {
  std::puts("rate,time_s,wanted_ev,gain_ev");
  for (const int rate : {12, 24, 60, 240}) {
    catchlight::render::ToneAdaptation adaptation(0.4, 1.6);
    for (int frame = 0; frame <= 12 * rate; ++frame) {
      const double time_s = static_cast<double>(frame) / rate, ev = wanted_ev(time_s, frame);
      const catchlight::ToneCurve wanted{std::exp2(ev), 1}, drawn = adaptation.at(time_s).value_or(wanted);
      adaptation.see(time_s, wanted);
      std::printf("%d,%.6f,%.4f,%.6f\n", rate, time_s, ev, std::log2(drawn.gain));
    }
  }
}
