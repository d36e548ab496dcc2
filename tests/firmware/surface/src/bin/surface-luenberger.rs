//! Everything of `kestirim-luenberger`, linked.

#![no_std]
#![no_main]

surface::image!(surface::luenberger::run);
