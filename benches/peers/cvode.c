/* CVODE with root finding, in C: each contact state to its first event; initialised anew beyond it.

   cc -O3 -o cvode cvode.c -lsundials_cvode -lsundials_nvecserial -lsundials_sunmatrixdense \
      -lsundials_sunlinsoldense -lsundials_sunnonlinsolfixedpoint -lsundials_generic -lm

   The state: q, y, q', y', and the integral of the squared observed velocity over the window. Adams is solved by fixed-point
   iteration, BDF by Newton's with the exact Jacobian. */

#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sundials/sundials_dense.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

enum { MOST = 32, EVENTS = 100000, STEPS = 10000000, RUNS = 200 };
enum contact { FLIGHT, FLOOR, CEILING };
static const double PATIENCE = 0.7;

struct face { double stiffness, damping; };
struct particle { double mass, gap, row[MOST], answer[MOST]; struct face faces[3]; };
struct guard { int particle, direction; double offset; enum contact next; const char *word; };
struct event { double time; int particle; const char *word; };

struct problem {
    int n, p, order, skip, cycles;
    double damping[MOST][MOST], stiffness[MOST][MOST], jump[MOST], observed[MOST], gravity, period, start[MOST];
    struct particle particles[MOST];
    /* Of the contact state: z' = a z + b. */
    enum contact contacts[MOST];
    double a[MOST][MOST], b[MOST];
    int averaged, guards;
    struct guard guard[MOST];
    struct event *events;
    int count;
};

static void numbers(FILE *file, double *into, int count) {
    for (int i = 0; i < count; i++) {
        if (fscanf(file, "%lf", &into[i]) != 1) { fprintf(stderr, "the scene ends early\n"); exit(1); }
    }
}

/* As `benches/peers/scene.rs` writes it. */
static void read_scene(const char *path, struct problem *s) {
    FILE *file = fopen(path, "r");
    if (!file) { perror(path); exit(1); }
    double sizes[4], scalars[2], laws[4], matrices[3][MOST * MOST], row[MOST];
    numbers(file, sizes, 4);
    int n = s->n = (int)sizes[0], p = s->p = (int)sizes[1];
    s->skip = (int)sizes[2], s->cycles = (int)sizes[3], s->order = 2 * (n + p);
    if (s->order >= MOST) { fprintf(stderr, "the scene is too large\n"); exit(1); }
    numbers(file, scalars, 2);
    s->gravity = scalars[0], s->period = scalars[1];
    for (int i = 0; i < 3; i++) numbers(file, matrices[i], n * n);
    numbers(file, s->jump, n);
    numbers(file, s->observed, n);
    for (int j = 0; j < p; j++) {
        struct particle *one = &s->particles[j];
        numbers(file, &one->mass, 1);
        numbers(file, &one->gap, 1);
        numbers(file, one->row, n);
        numbers(file, laws, 4);
        one->faces[FLOOR] = (struct face){laws[0], laws[1]};
        one->faces[CEILING] = (struct face){laws[2], laws[3]};
    }
    numbers(file, s->start, s->order);
    fclose(file);
    /* All that the structure answers with: by the inverse of its mass. */
    double **mass = SUNDlsMat_newDenseMat(n, n);
    sunindextype *pivots = SUNDlsMat_newIndexArray(n);
    for (int i = 0; i < n; i++) for (int k = 0; k < n; k++) mass[k][i] = matrices[0][i * n + k];
    SUNDlsMat_denseGETRF(mass, n, n, pivots);
    for (int k = 0; k < n; k++) {
        for (int m = 1; m < 3; m++) {
            for (int i = 0; i < n; i++) row[i] = matrices[m][i * n + k];
            SUNDlsMat_denseGETRS(mass, n, pivots, row);
            for (int i = 0; i < n; i++) (m == 1 ? s->damping : s->stiffness)[i][k] = row[i];
        }
    }
    SUNDlsMat_denseGETRS(mass, n, pivots, s->jump);
    for (int j = 0; j < p; j++) {
        memcpy(s->particles[j].answer, s->particles[j].row, sizeof row);
        SUNDlsMat_denseGETRS(mass, n, pivots, s->particles[j].answer);
    }
    SUNDlsMat_destroyMat(mass);
    SUNDlsMat_destroyArray(pivots);
}

static double distance(const struct problem *s, const struct guard *guard, const double *z) {
    double u = z[s->n + guard->particle] - guard->offset;
    for (int i = 0; i < s->n; i++) u -= s->particles[guard->particle].row[i] * z[i];
    return u;
}

static double speed(const struct problem *s, const struct guard *guard, const double *z) {
    struct guard moving = *guard;
    moving.offset = 0.0;
    return distance(s, &moving, z + s->n + s->p);
}

/* The equations of a contact state, and the surfaces that end it. */
static void compile(struct problem *s) {
    int n = s->n, v = s->n + s->p;
    memset(s->a, 0, sizeof s->a);
    memset(s->b, 0, sizeof s->b);
    s->guards = 0;
    for (int i = 0; i < v; i++) s->a[i][v + i] = 1.0;
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++) s->a[v + i][k] = -s->stiffness[i][k], s->a[v + i][v + k] = -s->damping[i][k];
    }
    for (int j = 0; j < s->p; j++) {
        const struct particle *one = &s->particles[j];
        s->b[v + n + j] = -s->gravity;
        if (s->contacts[j] == FLIGHT) {
            s->guard[s->guards++] = (struct guard){j, -1, 0.0, FLOOR, "floor_contact"};
            s->guard[s->guards++] = (struct guard){j, 1, one->gap, CEILING, "ceiling_contact"};
            continue;
        }
        int on_floor = s->contacts[j] == FLOOR;
        struct face face = one->faces[s->contacts[j]];
        double offset = on_floor ? 0.0 : one->gap;
        s->guard[s->guards++] = (struct guard){j, on_floor ? 1 : -1, offset, FLIGHT, on_floor ? "floor_release" : "ceiling_release"};
        /* The push on the particle is -k u - c u'; its share of each row. */
        for (int i = 0; i <= n; i++) {
            int at = v + (i < n ? i : n + j);
            double share = i < n ? -one->answer[i] : 1.0 / one->mass;
            for (int k = 0; k < n; k++) {
                s->a[at][k] += share * face.stiffness * one->row[k];
                s->a[at][v + k] += share * face.damping * one->row[k];
            }
            s->a[at][n + j] -= share * face.stiffness;
            s->a[at][v + n + j] -= share * face.damping;
            s->b[at] += share * face.stiffness * offset;
        }
    }
}

static double observed(const struct problem *s, const double *z) {
    double rate = 0.0;
    for (int i = 0; i < s->n; i++) rate += s->observed[i] * z[s->n + s->p + i];
    return rate;
}

static int slope(realtype t, N_Vector at, N_Vector out, void *data) {
    (void)t;
    const struct problem *s = data;
    const double *z = N_VGetArrayPointer(at);
    double *dz = N_VGetArrayPointer(out);
    for (int i = 0; i < s->order; i++) {
        double sum = s->b[i];
        for (int k = 0; k < s->order; k++) sum += s->a[i][k] * z[k];
        dz[i] = sum;
    }
    double rate = observed(s, z);
    dz[s->order] = s->averaged ? rate * rate : 0.0;
    return 0;
}

static int jacobian(realtype t, N_Vector at, N_Vector f, SUNMatrix out, void *data, N_Vector x, N_Vector y, N_Vector w) {
    (void)t, (void)f, (void)x, (void)y, (void)w;
    const struct problem *s = data;
    for (int i = 0; i < s->order; i++) for (int k = 0; k < s->order; k++) SM_ELEMENT_D(out, i, k) = s->a[i][k];
    double rate = s->averaged ? 2.0 * observed(s, N_VGetArrayPointer(at)) : 0.0;
    for (int i = 0; i < s->n; i++) SM_ELEMENT_D(out, s->order, s->n + s->p + i) = rate * s->observed[i];
    return 0;
}

static int surfaces(realtype t, N_Vector at, realtype *out, void *data) {
    (void)t;
    const struct problem *s = data;
    for (int i = 0; i < s->guards; i++) out[i] = distance(s, &s->guard[i], N_VGetArrayPointer(at));
    return 0;
}

static void enter(struct problem *s, const struct guard *guard, double time) {
    s->contacts[guard->particle] = guard->next;
    if (s->count < EVENTS) s->events[s->count] = (struct event){time, guard->particle, guard->word};
    s->count++;
}

/* From impulse to impulse and event to event; NULL, or why it failed. */
static const char *run(struct problem *s, void *solver, N_Vector at, double *rms) {
    double *z = N_VGetArrayPointer(at);
    memcpy(z, s->start, s->order * sizeof *z);
    z[s->order] = 0.0;
    s->count = 0;
    for (int j = 0; j < s->p; j++) s->contacts[j] = FLOOR;
    for (int cycle = 0; cycle < s->cycles; cycle++) {
        for (int i = 0; i < s->n; i++) z[s->n + s->p + i] += s->jump[i];
        s->averaged = cycle >= s->skip;
        double t = 0.0;
        int still = 0;
        while (t < s->period) {
            int directions[MOST], found[MOST];
            double before = t;
            compile(s);
            for (int i = 0; i < s->guards; i++) directions[i] = s->guard[i].direction;
            CVodeReInit(solver, t, at);
            CVodeRootInit(solver, s->guards, surfaces);
            CVodeSetRootDirection(solver, directions);
            CVodeSetStopTime(solver, s->period);
            int flag = CVode(solver, s->period, at, &t, CV_NORMAL);
            if (flag == CV_TOO_CLOSE) break;
            if (flag < 0) return CVodeGetReturnFlagName(flag);
            if (flag == CV_ROOT_RETURN) {
                CVodeGetRootInfo(solver, found);
                struct guard met[MOST];
                int hits = 0;
                for (int i = 0; i < s->guards; i++) {
                    double way = directions[i] * speed(s, &s->guard[i], z);
                    /* With it all that lie behind already and are left further behind. */
                    if (found[i] || (way > 0.0 && directions[i] * distance(s, &s->guard[i], z) > 0.0)) met[hits++] = s->guard[i];
                }
                for (int i = 0; i < hits; i++) enter(s, &met[i], cycle * s->period + t);
            }
            still = t == before ? still + 1 : 0;
            if (still > 64) return "no progress";
        }
    }
    *rms = sqrt(z[s->order] / ((s->cycles - s->skip) * s->period));
    return NULL;
}

static double now(void) {
    struct timespec at;
    clock_gettime(CLOCK_MONOTONIC, &at);
    return at.tv_sec + 1e-9 * at.tv_nsec;
}

static void answer(struct problem *s, const char *path, int lmm, double rtol, int is_timed, SUNContext context) {
    const char *method = lmm == CV_ADAMS ? "Adams" : "BDF";
    double times[RUNS], rms = 0.0;
    int count = 0, size = s->order + 1;
    N_Vector at = N_VNew_Serial(size, context);
    N_VConst(0.0, at);
    SUNMatrix matrix = SUNDenseMatrix(size, size, context);
    SUNLinearSolver linear = SUNLinSol_Dense(at, matrix, context);
    SUNNonlinearSolver fixed = SUNNonlinSol_FixedPoint(at, 0, context);
    void *solver = CVodeCreate(lmm, context);
    CVodeInit(solver, slope, 0.0, at);
    CVodeSStolerances(solver, rtol, 1e-2 * rtol);
    CVodeSetUserData(solver, s);
    CVodeSetMaxNumSteps(solver, STEPS);
    CVodeSetNoInactiveRootWarn(solver);
    CVodeSetErrFile(solver, NULL);
    if (lmm == CV_ADAMS) {
        CVodeSetNonlinearSolver(solver, fixed);
    } else {
        CVodeSetLinearSolver(solver, linear, matrix);
        CVodeSetJacFn(solver, jacobian);
    }
    const char *failure = NULL;
    double begun = now();
    /* A slow run is its own median. */
    while (!failure && (!count || (is_timed && times[0] < PATIENCE && count < RUNS && now() - begun < 3.0 * PATIENCE))) {
        double begin = now();
        failure = run(s, solver, at, &rms);
        times[count++] = now() - begin;
    }
    printf("{\"file\": \"%s\", \"solver\": \"%s\", \"setting\": \"CVODE %s, rtol %.0e\", ", path, method, method, rtol);
    if (failure) {
        printf("\"failure\": \"%s\"}\n", failure);
    } else {
        printf("\"rms\": %.17g, \"events\": [", rms);
        for (int i = 0; i < s->count && i < EVENTS; i++) {
            struct event event = s->events[i];
            printf("%s[%.17g, %d, \"%s\"]", i ? ", " : "", event.time, event.particle, event.word);
        }
        printf("], \"times\": [");
        for (int i = 0; i < count; i++) printf("%s%.9g", i ? ", " : "", times[i]);
        printf("]}\n");
    }
    fflush(stdout);
    CVodeFree(&solver);
    SUNNonlinSolFree(fixed);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(at);
}

int main(int count, char **words) {
    static const double settings[] = {1e-4, 1e-6, 1e-9, 1e-12};
    static struct problem problem;
    SUNContext context;
    SUNContext_Create(NULL, &context);
    problem.events = malloc(EVENTS * sizeof *problem.events);
    int tightest = count > 1 && !strcmp(words[1], "--tightest");
    for (int file = 1 + tightest; file < count; file++) {
        read_scene(words[file], &problem);
        for (int lmm = CV_ADAMS; lmm <= CV_BDF; lmm++) {
            for (int i = tightest ? 3 : 0; i < 4; i++) answer(&problem, words[file], lmm, settings[i], !tightest, context);
        }
    }
    free(problem.events);
    SUNContext_Free(&context);
    return 0;
}
