#pragma once

#include <string>

namespace luciole {

/// Where Debian and Ubuntu install Chart.js, which draws the page's plots.
inline constexpr const char* kChartLibrary = "/usr/share/javascript/chart.js/chart.min.js";

/// Throws MachineError, as experimentPage() would, if Chart.js isn't installed.
void requireChartLibrary(const std::string& path = kChartLibrary);

/// The page of a many-light experiment: a single HTML file that contains its styles, scripts, Chart.js (with
/// its licence note) and `data`, and loads nothing from the network. data: JSON in UTF-8, as
/// host/tools/scale/page/page.js describes it. Throws MachineError if Chart.js isn't installed.
std::string experimentPage(const std::string& data);

}  // namespace luciole
