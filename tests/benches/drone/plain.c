/* The thesis' particle filter as one would write it down from its Table 2.1: what ours is measured against.
 *
 * Arguments: x, y (m) and loss (dB) of each measurement. Prints the seconds that each row of the table takes. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define L 500
#define WEIGHTS 100000
#define PI 3.14159265358979323846

struct particle {
    double x, y, weight;
};

struct measurement {
    double x, y, loss;
};

typedef void resampler(const double *weights, uint32_t *ancestors, int n);

static uint64_t state = 88172645463325252u;

static double uniform(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

static double density(double deviation, double sigma)
{
    double z = deviation / sigma;
    return exp(-0.5 * z * z) / (sigma * sqrt(2 * PI));
}

/* Eqs 2.1 and 2.7 to 2.11 in the urban environment, the drone 500 m high. */
static double likelihood(const struct particle *user, const struct measurement *m)
{
    double dx = user->x - m->x, dy = user->y - m->y, h = 500;
    double elevation = 180 / PI * atan(h / sqrt(dx * dx + dy * dy));
    double seen = 1 / (1 + 9.61 * exp(-0.16 * (elevation - 9.61)));
    double excess = m->loss - 20 * log10(4 * PI / 0.15 * sqrt(dx * dx + dy * dy + h * h));
    return seen * density(excess - 1, 10.39 * exp(-0.05 * elevation))
         + (1 - seen) * density(excess - 20, 29.6 * exp(-0.03 * elevation));
}

/* One draw in each n-th of the sum. */
static void strata(const double *weights, uint32_t *ancestors, int n, int fresh)
{
    double cumulative = weights[0], offset = uniform();
    int ancestor = 0;
    for (int i = 0; i < n; i++) {
        if (fresh)
            offset = uniform();
        while (cumulative < (i + offset) / n && ancestor < n - 1)
            cumulative += weights[++ancestor];
        ancestors[i] = ancestor;
    }
}

static void systematic(const double *weights, uint32_t *ancestors, int n)
{
    strata(weights, ancestors, n, 0);
}

static void stratified(const double *weights, uint32_t *ancestors, int n)
{
    strata(weights, ancestors, n, 1);
}

static void draw(const double *cumulative, int n, uint32_t *ancestors, int draws)
{
    for (int i = 0; i < draws; i++) {
        double place = uniform() * cumulative[n - 1];
        int low = 0, high = n - 1;
        while (low < high) {
            int middle = (low + high) / 2;
            if (cumulative[middle] <= place)
                low = middle + 1;
            else
                high = middle;
        }
        ancestors[i] = low;
    }
}

static void multinomial(const double *weights, uint32_t *ancestors, int n)
{
    double *cumulative = malloc(n * sizeof *cumulative), sum = 0;
    for (int i = 0; i < n; i++)
        cumulative[i] = sum += weights[i];
    draw(cumulative, n, ancestors, n);
    free(cumulative);
}

static void residual(const double *weights, uint32_t *ancestors, int n)
{
    double *cumulative = malloc(n * sizeof *cumulative), sum = 0;
    int drawn = 0;
    for (int i = 0; i < n; i++) {
        double share = n * weights[i];
        int whole = (int)share;
        for (int k = 0; k < whole && drawn < n; k++)
            ancestors[drawn++] = i;
        cumulative[i] = sum += share - whole;
    }
    draw(cumulative, n, ancestors + drawn, n - drawn);
    free(cumulative);
}

static struct particle cloud[L];
static double mean[2];

static void step(const struct measurement *m, double threshold)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < L; i++)
        sum += cloud[i].weight *= likelihood(&cloud[i], m);
    for (int i = 0; i < L; i++) {
        cloud[i].weight /= sum;
        squares += cloud[i].weight * cloud[i].weight;
    }
    if (1 / squares < threshold * L) {
        static struct particle parents[L];
        double weights[L];
        uint32_t ancestors[L];
        for (int i = 0; i < L; i++) {
            parents[i] = cloud[i];
            weights[i] = cloud[i].weight;
        }
        systematic(weights, ancestors, L);
        for (int i = 0; i < L; i++) {
            cloud[i] = parents[ancestors[i]];
            cloud[i].weight = 1.0 / L;
        }
    }
    mean[0] = mean[1] = 0;
    for (int i = 0; i < L; i++) {
        double radius = 10 * sqrt(-2 * log(1 - uniform())), angle = 2 * PI * uniform();
        cloud[i].x += radius * cos(angle);
        cloud[i].y += radius * sin(angle);
        mean[0] += cloud[i].weight * cloud[i].x;
        mean[1] += cloud[i].weight * cloud[i].y;
    }
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
}

/* A step, of the fastest of many rounds. */
static double time_of_step(const struct measurement *measurements, int count, double threshold)
{
    double fastest = INFINITY;
    for (int i = 0; i < L; i++)
        cloud[i] = (struct particle){2000 * uniform(), 2000 * uniform(), 1.0 / L};
    for (int round = 0; round < 200; round++) {
        double begin = seconds();
        for (int lap = 0; lap < 4; lap++)
            for (int k = 0; k < count; k++)
                step(&measurements[k], threshold);
        fastest = fmin(fastest, (seconds() - begin) / (4 * count));
    }
    return fastest;
}

static double time_of(resampler *resample, const double *weights)
{
    static uint32_t ancestors[WEIGHTS];
    double fastest = INFINITY;
    for (int round = 0; round < 50; round++) {
        double begin = seconds();
        resample(weights, ancestors, WEIGHTS);
        fastest = fmin(fastest, seconds() - begin);
    }
    return fastest;
}

int main(int argc, char **argv)
{
    static struct measurement measurements[100];
    static double weights[WEIGHTS];
    int count = 0;
    for (int i = 1; i + 2 < argc && count < 100; i += 3)
        measurements[count++] = (struct measurement){atof(argv[i]), atof(argv[i + 1]), atof(argv[i + 2])};
    double sum = 0;
    for (int i = 0; i < WEIGHTS; i++) {
        double root = uniform();
        sum += weights[i] = root * root;
    }
    for (int i = 0; i < WEIGHTS; i++)
        weights[i] /= sum;
    printf("%g %g ", time_of_step(measurements, count, 0.1), time_of_step(measurements, count, 2));
    printf("%g %g ", time_of(systematic, weights), time_of(stratified, weights));
    printf("%g %g\n", time_of(residual, weights), time_of(multinomial, weights));
    /* So that nothing is left out for want of a use. */
    fprintf(stderr, "%g %g\n", mean[0], mean[1]);
    return 0;
}
