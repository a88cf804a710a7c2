/* Foresight's public interface in C, over runtime/foresight.h: load a compiled database once, recognize its objects in
 * range images. C99 and later, C++. Link foresight_runtime; a program in C is linked by the C++ compiler or with
 * libstdc++.
 *
 * - Handles are opaque. What a function named _load or _create makes, the function named _release frees; NULL is taken.
 * - A database is immutable: any number of recognizers in any threads may share it, and it may be released while they
 * live. Have one recognizer and one result for each thread; no handle but a database may be used by two threads at
 * once.
 * - No exception leaves a function. Functions return a foresight_status; the message of the last failure in the calling
 *   thread is foresight_last_error().
 * - Structs start with `size`: the caller sets it to sizeof the struct, as the header it is compiled with has it. A
 * later version only appends fields: it leaves alone what lies beyond a caller's size, and takes what the caller did
 * not know as not set. Into a struct larger than the library knows, it writes 0 beyond its own fields; it refuses to
 * read one with anything but 0 there.
 * - Units: mm, rad, ms. Sensor frame: x right, y down, z forward, origin at the camera centre.
 *
 * Versions: runtime/README.md. */
#ifndef FORESIGHT_C_H
#define FORESIGHT_C_H

#include <stdint.h>

/* The version of this interface, the project's own. */
#define FORESIGHT_API_VERSION_MAJOR 0
#define FORESIGHT_API_VERSION_MINOR 1
#define FORESIGHT_API_VERSION_PATCH 0
#define FORESIGHT_API_VERSION \
  (FORESIGHT_API_VERSION_MAJOR * 10000 + FORESIGHT_API_VERSION_MINOR * 100 + FORESIGHT_API_VERSION_PATCH)
/* Programs compiled for one ABI version run with every library of the same ABI version that is not older. */
#define FORESIGHT_ABI_VERSION 1

#if defined(_WIN32)
#define FORESIGHT_API
#else
#define FORESIGHT_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The exit codes of the programs. The first three leave a result, the others none. */
typedef int32_t foresight_status;
#define FORESIGHT_DONE 0          /* done; of foresight_recognize: something recognized */
#define FORESIGHT_NOTHING_FOUND 1 /* ran well, nothing recognized (or a selftest fell short) */
#define FORESIGHT_DEADLINE 5      /* deadline reached; the result holds what was found until then */
#define FORESIGHT_USAGE 2     /* a handle or struct that cannot be, an option outside its limits, an index too large */
#define FORESIGHT_BAD_INPUT 3 /* a file or range image that cannot be used */
#define FORESIGHT_BAD_DATABASE 4 /* a bad, foreign or incompatible database */
#define FORESIGHT_INTERNAL 70    /* no memory, or a bug: please report it */

typedef struct foresight_database foresight_database;
typedef struct foresight_recognizer foresight_recognizer;
typedef struct foresight_result foresight_result;

/* "0.1.0", and the ABI version, of the library that runs: compare with the macros the program was compiled with. */
FORESIGHT_API const char* foresight_version(void);
FORESIGHT_API uint32_t foresight_abi_version(void);

/* What failed last in the calling thread, `FILE: cause; what to do`; "" when nothing has. Holds until the next failure.
 */
FORESIGHT_API const char* foresight_last_error(void);

/* Databases. *database is set only when FORESIGHT_DONE is returned. */
FORESIGHT_API foresight_status foresight_database_load(const char* file, foresight_database** database);
/* From memory, for programs without a file system: the bytes of a database file. They may go once it returns. */
FORESIGHT_API foresight_status foresight_database_load_bytes(const void* data, uint64_t byte_count,
                                                             foresight_database** database);
FORESIGHT_API void foresight_database_release(foresight_database* database);

typedef struct foresight_object {
  uint32_t size;
  uint32_t reserved;    /* 0 */
  const char* name;     /* as long as the database lives */
  double box_centre[3]; /* of the bounding box, along the model's axes; model frame, mm */
  double box_size[3];   /* mm */
  double diameter;      /* largest distance between two vertices, mm */
} foresight_object;

FORESIGHT_API uint32_t foresight_database_object_count(const foresight_database* database);
FORESIGHT_API foresight_status foresight_database_object(const foresight_database* database, uint32_t index,
                                                         foresight_object* object);

/* Whether this library on this machine still recognizes each object of the database in its golden scan: the simulated
 * scan in which the compiler recognized it. FORESIGHT_DONE when no object fails and at least one was tested, else
 * FORESIGHT_NOTHING_FOUND. Takes as long as a scan for each object.
 * failed: how many objects fail; NULL is taken. text: a line for each object and a last one of all, cut to capacity - 1
 * bytes and ended with 0; NULL is taken with capacity 0. */
FORESIGHT_API foresight_status foresight_database_selftest(const foresight_database* database, uint32_t* failed,
                                                           char* text, uint64_t capacity);

/* Options of a recognizer; foresight.h says more. */
#define FORESIGHT_METHOD_TWO_WAY 0
#define FORESIGHT_METHOD_PAPER 1
#define FORESIGHT_LOSS_LORENTZIAN 0
#define FORESIGHT_LOSS_TUKEY 1
#define FORESIGHT_LOSS_HUBER 2
#define FORESIGHT_LOSS_GAUSSIAN 3

typedef struct foresight_options {
  uint32_t size;
  int32_t method;             /* FORESIGHT_METHOD_... */
  int32_t loss;               /* FORESIGHT_LOSS_... */
  int32_t most_detections;    /* stop after this many, 0 = no limit */
  int32_t most_verifications; /* stop after this many, 0 = no limit */
  int32_t reserved;           /* 0 */
  uint64_t reserved_memory;   /* bytes taken from the heap at once, so that recognition needs none; see foresight.h */
} foresight_options;

/* All 0 but the size are the defaults: `foresight_options options = FORESIGHT_OPTIONS_DEFAULT;` */
#define FORESIGHT_OPTIONS_DEFAULT \
  { sizeof(foresight_options), 0, 0, 0, 0, 0, 0 }

/* options: NULL for the defaults. *recognizer is set only when FORESIGHT_DONE is returned. */
FORESIGHT_API foresight_status foresight_recognizer_create(const foresight_database* database,
                                                           const foresight_options* options,
                                                           foresight_recognizer** recognizer);
FORESIGHT_API void foresight_recognizer_release(foresight_recognizer* recognizer);

/* A range image in the caller's memory, read while foresight_recognize runs. */
typedef struct foresight_image {
  uint32_t size;
  int32_t rows;     /* 32 to 4096 */
  int32_t columns;  /* 32 to 4096 */
  int32_t reserved; /* 0 */
  const float* xyz; /* rows*columns*3 values, row by row, mm; an invalid cell has NaN in all three */
} foresight_image;

#define FORESIGHT_NO_DEADLINE (-1)

/* A result to be filled again and again. */
FORESIGHT_API foresight_status foresight_result_create(foresight_result** result);
FORESIGHT_API void foresight_result_release(foresight_result* result);

/* Replaces what the result holds; a failure leaves it empty. deadline_ms: from the call, or FORESIGHT_NO_DEADLINE.
 * With a recognizer and a result that have seen such scans before, or with enough reserved_memory: no allocation, no
 * lock, no system call (runtime/README.md says when). */
FORESIGHT_API foresight_status foresight_recognize(const foresight_recognizer* recognizer, const foresight_image* image,
                                                   int32_t deadline_ms, foresight_result* result);

/* One recognized object. Pointers hold until the result is filled again or released. */
typedef struct foresight_detection {
  uint32_t size;
  int32_t rank;          /* place of its start pose in the ordered list, from 1 */
  const char* object;    /* name of the compiled model */
  double pose[16];       /* row-major 4x4; takes model points (mm) into the sensor frame (mm) */
  double quaternion[4];  /* of the pose's rotation: w, x, y, z, unit, w >= 0 */
  double covariance[36]; /* row-major 6x6: x, y, z (mm), rotation vector (rad), along the sensor's axes; the rotation
                            error on the left and about the model's origin. See Detection in foresight.h. */
  double score;          /* 0 to 1: how probably the pose is right */
  double matched;        /* alpha, beta, gamma of the paper */
  double coherent;
  double occluding;
  double box_centre[3]; /* of the CAD model's bounding box; model frame, mm */
  double box_size[3];   /* mm */
  const int32_t* faces; /* faces in sight, and as many regions that show them */
  const int32_t* regions;
  uint32_t face_count;
  uint32_t region_count;
  uint32_t alternative_count; /* other poses or objects that the view fits equally well */
  uint32_t reserved;          /* 0 */
} foresight_detection;

typedef struct foresight_alternative {
  uint32_t size;
  uint32_t reserved; /* 0 */
  const char* object;
  double pose[16];
  double score;
} foresight_alternative;

FORESIGHT_API uint32_t foresight_result_detection_count(const foresight_result* result);
FORESIGHT_API foresight_status foresight_result_detection(const foresight_result* result, uint32_t index,
                                                          foresight_detection* detection);
FORESIGHT_API foresight_status foresight_result_alternative(const foresight_result* result, uint32_t detection,
                                                            uint32_t index, foresight_alternative* alternative);

/* How much was searched: the columns of the paper's Fig. 9 and more. */
typedef struct foresight_statistics {
  uint32_t size;
  int32_t complete; /* 1; 0 when the deadline ended the search */
  int64_t regions;
  int64_t possible_matches;
  int64_t threshold_matches;
  int64_t active_matches;
  int64_t hypotheses;
  int64_t verifications;
  int64_t energy_evaluations;
  int64_t pose_checks;
  int64_t pool_bytes; /* of the recognizer's memory that were used */
} foresight_statistics;

/* Time of each stage, ms. */
typedef struct foresight_times {
  uint32_t size;
  uint32_t reserved; /* 0 */
  double extract;
  double field;
  double hypotheses;
  double localize;
  double verify;
  double total;
} foresight_times;

FORESIGHT_API foresight_status foresight_result_statistics(const foresight_result* result,
                                                           foresight_statistics* statistics);
FORESIGHT_API foresight_status foresight_result_times(const foresight_result* result, foresight_times* times);

#ifdef __cplusplus
}
#endif

#endif /* FORESIGHT_C_H */
