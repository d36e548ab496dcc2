//! Numbers published in the thesis, each with its table or figure.

/// Mean errors of the drone's thesis (Turkish; a drone base station finds a ground user by a particle filter), m,
/// 100 trials each. Table 3.2: L = 1000, T = 12, h = 500 m, circles of 2000 m divided by 2 to 8.
pub const RADIUS: [f64; 7] = [165.0, 133.0, 159.0, 183.0, 242.0, 261.0, 336.0];
/// Table 3.2: L = 1000, T = 12, r = 2000/3 m, h = 200 to 1400 m.
pub const HEIGHT: [f64; 7] = [363.0, 197.0, 126.0, 105.0, 103.0, 102.0, 110.0];
/// Table 3.2: h = 800 m, T = 12, r = 2000/3 m, L = 100, 500, … 3000.
pub const PARTICLES: [f64; 7] = [139.0, 96.0, 105.0, 97.0, 113.0, 96.0, 109.0];
/// Fig. 3.2, mean errors for T = 10 to 40: multinomial, residual, stratified, systematic.
pub const RESAMPLERS_MEAN: [[f64; 7]; 4] = [
    [106.0, 97.0, 88.0, 67.0, 68.0, 60.0, 56.0],
    [128.0, 97.0, 77.0, 68.0, 68.0, 60.0, 61.0],
    [106.0, 98.0, 88.0, 68.0, 67.0, 60.0, 55.0],
    [118.0, 98.0, 80.0, 68.0, 63.0, 55.0, 63.0],
];
/// Fig. 3.3: the largest of the same 100 errors for each T from 10 to 40, in the same order of resamplers.
pub const RESAMPLERS_MAXIMUM: [[f64; 7]; 4] = [
    [450.0, 395.0, 285.0, 213.0, 196.0, 190.0, 224.0],
    [455.0, 445.0, 234.0, 213.0, 212.0, 202.0, 205.0],
    [461.0, 397.0, 389.0, 210.0, 187.0, 232.0, 174.0],
    [445.0, 331.0, 232.0, 268.0, 206.0, 164.0, 203.0],
];
/// Fig. 3.4: energy of grid and circle for T = 4, 9, 16, 25, J.
pub const ENERGY: [[f64; 4]; 2] = [[329e3, 597e3, 860e3, 1130e3], [312e3, 426e3, 496e3, 564e3]];
/// Fig. 3.5: mean errors of grid and circle for T = 4, 9, 16, 25, m.
pub const TRAJECTORIES: [[f64; 4]; 2] = [[234.0, 79.0, 49.0, 39.0], [222.0, 76.0, 68.0, 44.0]];
/// Mean errors of circle and small grid for T = 16 and the same energy, m.
pub const EQUAL_ENERGY: [f64; 2] = [67.9, 84.0];
