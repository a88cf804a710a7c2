// Recognition results as text, as one JSON object a line, and as BOP CSV rows.
#pragma once

#include <string>
#include <vector>

#include "runtime/foresight.h"

namespace foresight {

// Keys in the documented order, numbers so that they read back to the same bits; one line, no line break at the end.
[[nodiscard]] std::string result_json(const std::string& scan, const RecognitionResult& result,
                                      double read_milliseconds);

// For eyes; several lines, each with its line break. Control characters of names are shown as '?'.
[[nodiscard]] std::string result_text(const std::string& scan, const RecognitionResult& result,
                                      double read_milliseconds);

// scene_id,im_id,obj_id,score,R,t,time (BOP toolkit): R nine and t three numbers separated by blanks, t in mm, time in
// s. im_id: the last number in the scan's file name, scene_id: the last number in its folder's name (in the one above
// where the folder is BOP's "depth"), 0 where there is none. obj_id: NUMBER where all objects of the database are named
// obj_NUMBER as BOP's are, no two with one number; else the place of the object in the database, from 1 (0: not in it).
// time: of the whole scan, reading included, the same in each row. Header and each row end with a line break; no
// detection, no row.
[[nodiscard]] std::string bop_csv_header();
[[nodiscard]] std::string bop_csv_rows(const std::string& scan, const RecognitionResult& result,
                                       const std::vector<std::string>& object_names, double read_milliseconds);

}  // namespace foresight
