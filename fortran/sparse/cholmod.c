/* Cholesky factors of a symmetric matrix some rows of which come last, by CHOLMOD: supernodal, with indices of 64 bits.

   In C, as CHOLMOD's settings and factors are structures of C whose layout differs from one of its versions to the next; Fortran sees
   them as a pointer (cholmod.f90, where each argument is named). Rows and columns count from 0. */
#include <omp.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <suitesparse/cholmod.h>

/* How a call ended; the same numbers in cholmod.f90. */
enum { done, indefinite, out_of_memory, failed };

typedef struct {
  cholmod_common common;
  cholmod_sparse *matrix;
  cholmod_factor *factor;
  int64_t inner;     /* rows that come first; the others follow in the order of their numbers */
  int64_t last;      /* how many these are */
  int64_t *order;    /* rows of the given matrix, by row of the factor: `matrix` is in that order already */
  int64_t *given;    /* the given entries, by entry of `matrix` */
  int64_t *diagonal; /* the entries of `matrix` on the diagonal, by row */
} cholesky;

static int ending(const cholmod_common *common) {
  switch (common->status) {
  case CHOLMOD_OK:
    return done;
  case CHOLMOD_NOT_POSDEF:
    return indefinite;
  case CHOLMOD_OUT_OF_MEMORY:
  case CHOLMOD_TOO_LARGE:
    return out_of_memory;
  default:
    return failed;
  }
}

void isomortar_cholesky_forget(cholesky **self) {
  if (!*self) return;
  cholmod_l_free_sparse(&(*self)->matrix, &(*self)->common);
  cholmod_l_free_factor(&(*self)->factor, &(*self)->common);
  cholmod_l_finish(&(*self)->common);
  free((*self)->order);
  free((*self)->given);
  free((*self)->diagonal);
  free(*self);
  *self = NULL;
}

/* Room for a matrix of which the lower half, by columns, counts. */
static cholmod_sparse *lower(int64_t rows, int64_t entries, cholmod_common *common) {
  return cholmod_l_allocate_sparse(rows, rows, entries, 0, 1, -1, CHOLMOD_REAL, common);
}

/* Settings, and a matrix of a pattern. */
static void begin(cholesky *self, int64_t rows, const int64_t *start, const int64_t *column) {
  cholmod_common *common = &self->common;
  /* Columns are joined more freely than CHOLMOD does by itself, which has scalar unknowns in mind: ours come by three a node. Factors of
     some hundred nodes take two thirds of the time, those of some thousand nine tenths. */
  const size_t widths[] = {32, 96, 256};
  const double zeros[] = {0.9, 0.2, 0.05};
  cholmod_l_start(common);
  common->print = 0;
  common->nmethods = 1;
  common->supernodal = CHOLMOD_SUPERNODAL;
  common->final_ll = 1;
  memcpy(common->nrelax, widths, sizeof widths);
  memcpy(common->zrelax, zeros, sizeof zeros);
  self->matrix = lower(rows, start[rows], common);
  if (!self->matrix) return;
  memcpy(self->matrix->p, start, (rows + 1) * sizeof(int64_t));
  memcpy(self->matrix->i, column, start[rows] * sizeof(int64_t));
}

int isomortar_cholesky_order(int64_t rows, const int64_t *start, const int64_t *column, int by_metis, int64_t *order, double *flops) {
  cholesky *self = calloc(1, sizeof(cholesky));
  if (!self) return out_of_memory;
  begin(self, rows, start, column);
  if (self->matrix) {
    self->common.method[0].ordering = by_metis ? CHOLMOD_METIS : CHOLMOD_AMD;
    self->factor = cholmod_l_analyze(self->matrix, &self->common);
  }
  if (self->factor) memcpy(order, self->factor->Perm, rows * sizeof(int64_t));
  *flops = self->common.fl;
  const int code = ending(&self->common);
  isomortar_cholesky_forget(&self);
  return code;
}

/* Put the last rows at the end of an order, by their numbers; the others stay in it. */
static void split(const cholesky *self, const int *is_last, const int64_t *given, int64_t *order) {
  const int64_t rows = self->inner + self->last;
  int64_t next = 0;
  for (int64_t k = 0; k < rows; k++)
    if (!is_last[given[k]]) order[next++] = given[k];
  for (int64_t row = 0; row < rows; row++)
    if (is_last[row]) order[next++] = row;
}

/* Put the matrix into the order of the factor, once: CHOLMOD, which would do so each time, takes up to a quarter of the time for it. Of the
   given entries one half counts, those at or beyond the diagonal in their row. `row` is room for a number a row. */
static void arrange(cholesky *self, int64_t *row) {
  cholmod_sparse *was = self->matrix;
  const int64_t *start = was->p, *column = was->i, rows = self->inner + self->last;
  cholmod_sparse *now = self->matrix = lower(rows, (start[rows] + rows) / 2, &self->common);
  if (now) {
    int64_t *first = now->p, *into = now->i;
    for (int64_t k = 0; k < rows; k++) row[self->order[k]] = k;
    memset(first, 0, (rows + 1) * sizeof(int64_t));
    for (int64_t j = 0; j < rows; j++)
      for (int64_t k = start[j]; k < start[j + 1]; k++)
        if (column[k] >= j) first[1 + (row[j] < row[column[k]] ? row[j] : row[column[k]])]++;
    for (int64_t k = 0; k < rows; k++) first[k + 1] += first[k];
    for (int64_t j = 0; j < rows; j++)
      for (int64_t k = start[j]; k < start[j + 1]; k++) {
        if (column[k] < j) continue;
        const int64_t one = row[j], other = row[column[k]];
        const int64_t entry = first[one < other ? one : other]++;
        into[entry] = one < other ? other : one;
        self->given[entry] = k;
        if (one == other) self->diagonal[one] = entry;
      }
    memmove(first + 1, first, rows * sizeof(int64_t));
    first[0] = 0;
  }
  cholmod_l_free_sparse(&was, &self->common);
}

/* Analyse with the last rows last. Those before are postordered by an analysis of their own, so that columns that can be joined are
   neighbours; the last rows are a path at the root of the tree, or several. `order` is that of all rows, and room for it. */
static void analyse_split(cholesky *self, const int *is_last, int64_t *order) {
  cholmod_common *common = &self->common;
  common->method[0].ordering = CHOLMOD_GIVEN;
  self->factor = cholmod_l_analyze_p(self->matrix, order, NULL, 0, common);
  if (!self->factor) return;
  split(self, is_last, self->factor->Perm, self->order);
  cholmod_l_free_factor(&self->factor, common);
  arrange(self, order);
  if (!self->matrix) return;
  common->method[0].ordering = CHOLMOD_NATURAL;
  common->postorder = 0;
  self->factor = cholmod_l_analyze(self->matrix, common);
}

/* An object without numbers for a matrix of so many rows and entries; nothing where memory runs out. */
static cholesky *reserve(int64_t rows, int64_t entries) {
  cholesky *self = calloc(1, sizeof(cholesky));
  if (!self) return NULL;
  self->order = malloc(rows * sizeof(int64_t));
  self->given = malloc((entries + rows) / 2 * sizeof(int64_t));
  self->diagonal = malloc(rows * sizeof(int64_t));
  if (self->order && self->given && self->diagonal) return self;
  free(self->order);
  free(self->given);
  free(self->diagonal);
  free(self);
  return NULL;
}

int isomortar_cholesky_analyse(int64_t rows, const int64_t *start, const int64_t *column, const int *is_last, const int64_t *given,
                               double *flops, double *entries, cholesky **self) {
  *self = reserve(rows, start[rows]);
  int64_t *order = malloc(rows * sizeof(int64_t));
  if (!*self || !order) {
    free(order);
    if (*self) isomortar_cholesky_forget(self);
    return out_of_memory;
  }
  begin(*self, rows, start, column);
  for (int64_t row = 0; row < rows; row++) (*self)->last += is_last[row];
  (*self)->inner = rows - (*self)->last;
  split(*self, is_last, given, order);
  if ((*self)->matrix) analyse_split(*self, is_last, order);
  free(order);

  const int code = ending(&(*self)->common);
  *flops = (*self)->common.fl;
  *entries = (*self)->common.lnz;
  if (code != done) isomortar_cholesky_forget(self);
  return code;
}

/* Copy the factor's rows and columns of the last rows; the result is the least of its pivots, as shares of the matrix' diagonal. */
static double read_factor(const cholesky *self, double *corner) {
  const cholmod_factor *factor = self->factor;
  const int64_t *first = factor->super, *row_start = factor->pi, *value_start = factor->px, *row = factor->s;
  const double *value = factor->x, *matrix = self->matrix->x;
  double least = 1.0;
  memset(corner, 0, self->last * self->last * sizeof(double));
  for (size_t node = 0; node < factor->nsuper; node++) {
    const int64_t height = row_start[node + 1] - row_start[node];
    for (int64_t column = first[node]; column < first[node + 1]; column++) {
      const int64_t top = column - first[node];
      const double *entry = value + value_start[node] + top * height;
      const double share = entry[top] * entry[top] / matrix[self->diagonal[column]];
      if (!(share >= least)) least = share;
      if (column < self->inner) continue;
      for (int64_t k = top; k < height; k++)
        corner[(column - self->inner) * self->last + row[row_start[node] + k] - self->inner] = entry[k];
    }
  }
  return least;
}

/* Factorise on this thread alone. CHOLMOD asks for four, whatever OMP_NUM_THREADS says: they would be in the way of other runs, and a process
   that is forked off later would wait for them for ever. */
static void factorise_alone(cholesky *self) {
  const int levels = omp_get_max_active_levels();
  omp_set_max_active_levels(0);
  cholmod_l_factorize(self->matrix, self->factor, &self->common);
  omp_set_max_active_levels(levels);
}

int isomortar_cholesky_factorise(cholesky *self, const double *values, double share, double *corner, double *shift, double *least) {
  double *entry = self->matrix->x;
  for (size_t k = 0; k < self->matrix->nzmax; k++) entry[k] = values[self->given[k]];
  for (int64_t k = 0; k < self->last; k++) {
    double *diagonal = entry + self->diagonal[self->inner + k];
    shift[k] = share * *diagonal;
    *diagonal += shift[k];
  }
  factorise_alone(self);
  const int code = ending(&self->common);
  if (code == done) *least = read_factor(self, corner);
  return code;
}

/* Solve with L, or with its transpose, in the place of a right-hand side in the numbering of the factor. */
static int substitute(cholesky *self, int system, double *right) {
  cholmod_common *common = &self->common;
  const int64_t rows = self->inner + self->last;
  cholmod_dense given = {rows, 1, rows, rows, right, NULL, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  cholmod_dense *found = cholmod_l_solve(system, self->factor, &given, common);
  if (found) memcpy(right, found->x, rows * sizeof(double));
  cholmod_l_free_dense(&found, common);
  return ending(common);
}

int isomortar_cholesky_forth(cholesky *self, const double *right, double *solution) {
  for (int64_t k = 0; k < self->inner + self->last; k++) solution[k] = right[self->order[k]];
  return substitute(self, CHOLMOD_L, solution);
}

int isomortar_cholesky_back(cholesky *self, const double *right, double *solution) {
  const int64_t rows = self->inner + self->last;
  double *numbered = malloc(rows * sizeof(double));
  if (!numbered) return out_of_memory;
  memcpy(numbered, right, rows * sizeof(double));
  const int code = substitute(self, CHOLMOD_Lt, numbered);
  for (int64_t k = 0; k < rows; k++) solution[self->order[k]] = numbered[k];
  free(numbered);
  return code;
}
