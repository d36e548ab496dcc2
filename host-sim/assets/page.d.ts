// Declarations of foreign code that the page's scripts use, for `tsc --checkJs`.
declare const Plotly: any;
