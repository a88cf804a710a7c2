/* How to use the library from C: C99, runtime/foresight_c.h alone.
 *
 *   api_example_c DATABASE SCAN.pcd    (an organized PCD in ascii, fields x y z, mm)
 *
 * Prints the detections: object, position, quaternion, and how far position and turn may be off. Ends with the exit
 * codes of the programs. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "runtime/foresight_c.h"

/* Fills in size, rows, columns and xyz, which the caller frees. 0 when the file is no such scan. */
static int read_ascii_pcd(const char* file, foresight_image* image, float** xyz) {
  char line[256];
  size_t count, i;
  FILE* in = fopen(file, "r");
  if (in == NULL) return 0;
  memset(image, 0, sizeof *image);
  image->size = (uint32_t)sizeof *image;
  while (fgets(line, sizeof line, in) != NULL && strncmp(line, "DATA", 4) != 0) {
    if (strncmp(line, "WIDTH ", 6) == 0) image->columns = (int32_t)strtol(line + 6, NULL, 10);
    if (strncmp(line, "HEIGHT ", 7) == 0) image->rows = (int32_t)strtol(line + 7, NULL, 10);
  }
  count = image->rows > 0 && image->columns > 0 ? 3 * (size_t)image->rows * (size_t)image->columns : 0;
  *xyz = count > 0 ? malloc(count * sizeof **xyz) : NULL;
  for (i = 0; *xyz != NULL && i < count && fscanf(in, "%255s", line) == 1; ++i) {
    (*xyz)[i] = strtof(line, NULL); /* takes "nan" too */
  }
  fclose(in);
  image->xyz = *xyz;
  return *xyz != NULL && i == count;
}

/* Standard deviation along all three axes from a row of the covariance on. */
static double deviation(const double* covariance, int first) {
  return sqrt(covariance[7 * first] + covariance[7 * (first + 1)] + covariance[7 * (first + 2)]);
}

static void print_detections(const foresight_result* result) {
  uint32_t i;
  for (i = 0; i < foresight_result_detection_count(result); ++i) {
    foresight_detection found;
    found.size = (uint32_t)sizeof found;
    if (foresight_result_detection(result, i, &found) != FORESIGHT_DONE) continue;
    printf("%s %g %g %g %g %g %g %g +-%g mm +-%g rad\n", found.object, found.pose[3], found.pose[7], found.pose[11],
           found.quaternion[0], found.quaternion[1], found.quaternion[2], found.quaternion[3],
           deviation(found.covariance, 0), deviation(found.covariance, 3));
  }
}

/* One thread's work: a database may serve many threads, a recognizer and a result belong to one. */
static foresight_status recognize(const foresight_database* database, const foresight_image* image) {
  foresight_recognizer* recognizer = NULL;
  foresight_result* result = NULL;
  foresight_status status = foresight_recognizer_create(database, NULL, &recognizer);
  if (status == FORESIGHT_DONE) status = foresight_result_create(&result);
  if (status == FORESIGHT_DONE) status = foresight_recognize(recognizer, image, 60000, result);
  print_detections(result); /* none unless it is done or at its deadline */
  foresight_result_release(result);
  foresight_recognizer_release(recognizer);
  return status;
}

int main(int argc, char** argv) {
  foresight_database* database = NULL;
  foresight_image image;
  float* xyz = NULL;
  foresight_status status;
  if (argc != 3) return FORESIGHT_USAGE;
  if (foresight_abi_version() != FORESIGHT_ABI_VERSION) return FORESIGHT_INTERNAL;
  status = foresight_database_load(argv[1], &database);
  if (status == FORESIGHT_DONE && !read_ascii_pcd(argv[2], &image, &xyz)) {
    fprintf(stderr, "%s: is no organized ascii PCD\n", argv[2]);
    foresight_database_release(database);
    free(xyz);
    return FORESIGHT_BAD_INPUT;
  }
  if (status == FORESIGHT_DONE) status = recognize(database, &image);
  if (status != FORESIGHT_DONE && status != FORESIGHT_NOTHING_FOUND && status != FORESIGHT_DEADLINE) {
    fprintf(stderr, "%s\n", foresight_last_error());
  }
  foresight_database_release(database);
  free(xyz);
  return (int)status;
}
