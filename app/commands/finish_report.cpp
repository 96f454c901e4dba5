#include "app/commands/finish_report.hpp"

namespace catchlight::app {

void finish_report(const Session& session, const std::string& path, bool overwrite, Context& context) {
  warn_of_lost_frames(session.report(), context.log);
  const Report report = session.report();  // with that warning
  if (!path.empty()) write_report(path, report, overwrite);
  context.log.info(report_summary(report));
  if (!session.damage()) return;
  context.log.error(*session.damage());
  context.exit_code = 1;
}

}  // namespace catchlight::app
