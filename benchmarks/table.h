// One table, twice: as CSV for programs and in columns for eyes.
#pragma once

#include <string>
#include <vector>

namespace foresight {

struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  // each as wide as the header
};

// Fixed number of decimals, independent of the locale; "-" for NaN (a mean over nothing).
[[nodiscard]] std::string decimal(double value, int decimals);

// RFC 4180, with "\n" line ends.
[[nodiscard]] std::string to_csv(const Table& table);

// Left column flush left, the others flush right, two blanks between.
[[nodiscard]] std::string to_text(const Table& table);

}  // namespace foresight
