#include "app/commands/finish_report.hpp"

namespace catchlight::app {

void finish_report(Session& session, const std::string& path, bool overwrite, Context& context) {
  session.warn_of_track();
  const Report report = session.report();  // with these warnings
  if (!path.empty()) write_report(path, report, overwrite);
  context.log.info(report_summary(report));
  if (const std::string details = report_details(report); !details.empty()) context.log.detail(details);
  for (const std::string& failure : session.failures()) {
    context.log.error(failure);
    context.exit_code = 1;
  }
}

}  // namespace catchlight::app
