"""`shaken calibrate`: the rotational noise with which rods have a wanted rotational diffusion coefficient.

diffusion  D_r from mean square angular displacements of independent runs
rods       runs of the rods of one species, and the lengths that they need
search     the noise that gives a wanted D_r
app        the command line
"""
