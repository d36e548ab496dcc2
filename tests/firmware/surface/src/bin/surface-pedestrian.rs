//! Everything of `kestirim-pedestrian`, linked.

#![no_std]
#![no_main]

surface::image!(surface::pedestrian::run);
