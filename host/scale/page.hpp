#pragma once

#include <string>

namespace luciole {

/// Where Debian and Ubuntu put Chart.js, which draws the page's plots.
inline constexpr const char* kChartLibrary = "/usr/share/javascript/chart.js/chart.min.js";

/// Throws the MachineError that experimentPage would meet where Chart.js isn't installed.
void requireChartLibrary(const std::string& path = kChartLibrary);

/// The page of a many-light experiment: one HTML file with its styles, scripts, Chart.js (with its licence
/// note) and `data` inside, that asks the network for nothing. `data` is JSON in UTF-8, as
/// host/scale/page/page.js describes it. Throws MachineError: Chart.js isn't installed.
std::string experimentPage(const std::string& data);

}  // namespace luciole
