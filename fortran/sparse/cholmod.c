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
  int64_t *diagonal; /* the entries on the diagonal, by row of the factor */
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
  free((*self)->diagonal);
  free(*self);
  *self = NULL;
}

/* Settings, and a place for a matrix of a pattern; `stype` says which half of it counts. */
static void begin(cholesky *self, int64_t rows, const int64_t *start, const int64_t *column) {
  cholmod_common *common = &self->common;
  /* Columns are joined more freely than CHOLMOD does by itself, which has scalar unknowns in mind: ours come by three a node. Factors of
     five hundred to a thousand nodes take a quarter to a third less time, larger ones as long. */
  const size_t widths[] = {16, 48, 128};
  const double zeros[] = {0.9, 0.4, 0.15};
  cholmod_l_start(common);
  common->print = 0;
  common->nmethods = 1;
  common->supernodal = CHOLMOD_SUPERNODAL;
  common->final_ll = 1;
  memcpy(common->nrelax, widths, sizeof widths);
  memcpy(common->zrelax, zeros, sizeof zeros);
  self->matrix = cholmod_l_allocate_sparse(rows, rows, start[rows], 1, 1, -1, CHOLMOD_REAL, common);
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

/* Analyse with the last rows last. Those before are postordered by an analysis of their own, so that columns that can be joined are
   neighbours; the last rows are a path at the root of the tree, or several. */
static void analyse_split(cholesky *self, const int *is_last, int64_t *order) {
  cholmod_common *common = &self->common;
  common->method[0].ordering = CHOLMOD_GIVEN;
  self->factor = cholmod_l_analyze_p(self->matrix, order, NULL, 0, common);
  if (!self->factor) return;
  split(self, is_last, self->factor->Perm, order);
  cholmod_l_free_factor(&self->factor, common);
  common->postorder = 0;
  self->factor = cholmod_l_analyze_p(self->matrix, order, NULL, 0, common);
}

int isomortar_cholesky_analyse(int64_t rows, const int64_t *start, const int64_t *column, const int *is_last, const int64_t *given,
                               double *flops, double *entries, cholesky **self) {
  *self = calloc(1, sizeof(cholesky));
  int64_t *order = malloc(rows * sizeof(int64_t));
  if (!*self || !order) {
    free(order);
    free(*self);
    *self = NULL;
    return out_of_memory;
  }
  begin(*self, rows, start, column);
  for (int64_t row = 0; row < rows; row++) (*self)->last += is_last[row];
  (*self)->inner = rows - (*self)->last;
  split(*self, is_last, given, order);
  if ((*self)->matrix) analyse_split(*self, is_last, order);
  (*self)->diagonal = malloc(rows * sizeof(int64_t));
  if (!(*self)->diagonal) (*self)->common.status = CHOLMOD_OUT_OF_MEMORY;
  for (int64_t k = 0; (*self)->diagonal && k < rows; k++) {
    int64_t entry = start[order[k]];
    while (column[entry] != order[k]) entry++;
    (*self)->diagonal[k] = entry;
  }
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
  memcpy(entry, values, self->matrix->nzmax * sizeof(double));
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

/* Solve with L, forth from the numbering of the matrix to that of the factor, or with its transpose, and back. */
static int substitute(cholesky *self, int first, int second, const double *right, double *solution) {
  cholmod_common *common = &self->common;
  const int64_t rows = self->inner + self->last;
  cholmod_dense given = {rows, 1, rows, rows, (void *)right, NULL, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  cholmod_dense *between = cholmod_l_solve(first, self->factor, &given, common);
  cholmod_dense *found = between ? cholmod_l_solve(second, self->factor, between, common) : NULL;
  if (found) memcpy(solution, found->x, rows * sizeof(double));
  cholmod_l_free_dense(&between, common);
  cholmod_l_free_dense(&found, common);
  return ending(common);
}

int isomortar_cholesky_forth(cholesky *self, const double *right, double *solution) {
  return substitute(self, CHOLMOD_P, CHOLMOD_L, right, solution);
}

int isomortar_cholesky_back(cholesky *self, const double *right, double *solution) {
  return substitute(self, CHOLMOD_Lt, CHOLMOD_Pt, right, solution);
}
