"""`shaken calibrate`: the rotational noise with which rods have a wanted rotational diffusion coefficient."""
