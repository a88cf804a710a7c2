#include "benchmarks/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace foresight {
namespace {

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\n") == std::string::npos) return cell;
  std::string text = "\"";
  for (const char c : cell) {
    if (c == '"') text += '"';
    text += c;
  }
  return text + "\"";
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    line += quoted(cells[i]);
  }
  return line + "\n";
}

std::string text_line(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line.append(2 + widths[i] - cells[i].size(), ' ');
    line += cells[i];
    if (i == 0) line.append(widths[i] - cells[i].size(), ' ');
  }
  return line + "\n";
}

}  // namespace

std::string decimal(double value, int decimals) {
  if (std::isnan(value)) return "-";
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
  return {buffer, end};
}

std::string to_csv(const Table& table) {
  std::string text = csv_line(table.header);
  for (const auto& row : table.rows) text += csv_line(row);
  return text;
}

std::string to_text(const Table& table) {
  std::vector<std::size_t> widths(table.header.size(), 0);
  for (std::size_t i = 0; i < widths.size(); ++i) {
    widths[i] = table.header[i].size();
    for (const auto& row : table.rows) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text = text_line(table.header, widths);
  for (const auto& row : table.rows) text += text_line(row, widths);
  return text;
}

}  // namespace foresight
