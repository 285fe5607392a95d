#pragma once

/// 10000 · major + 100 · minor + patch.
#define LUCIOLE_VERSION_NUMBER 10000
