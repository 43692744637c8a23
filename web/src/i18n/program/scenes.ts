/** Portuguese titles, summaries and comments of the scenes of the gallery. */
export const scenes: Record<string, string> = {
  // steer
  'Steer a swarm along a route': 'Conduzir um enxame por uma rota',
  'A feedback controller steers a swarm along four setpoints; drag on the picture to pull the swarm.': 'Um controlador em malha fechada conduz um enxame por quatro pontos de referência; arraste sobre a imagem para puxar o enxame.',
  'A swarm of IT-1 cells starts at the left and is steered along a route inside a drop.': 'Um enxame de células IT-1 começa à esquerda e é conduzido por uma rota dentro de uma gota.',
  // step-response
  'Step response': 'Resposta ao degrau',
  'Cells accumulate at the edge of a drop; the field is reversed after one second, and they swim away.': 'As células se acumulam na borda de uma gota; o campo é invertido após um segundo, e elas nadam para longe.',
  'The step response of the thesis by L. F. M. Diniz, 2016 (its section 3.4.1): cells accumulate at the left edge of a drop; the field is reversed after one second, and the cells swim across the picture.': 'A resposta ao degrau da tese de L. F. M. Diniz, 2016 (sua seção 3.4.1): as células se acumulam na borda esquerda de uma gota; o campo é invertido após um segundo, e as células nadam através da imagem.',
  // drop
  'Swarm steered to the centre of a drop': 'Enxame conduzido ao centro de uma gota',
  'A controller with duty-cycle actuation steers a swarm from the edge to the centre of a round drop.': 'Um controlador com atuação por ciclo de trabalho conduz um enxame da borda ao centro de uma gota redonda.',
  'A swarm is steered to the centre of a round drop.': 'Um enxame é conduzido ao centro de uma gota redonda.',
  // bench
  'Swarm at a setpoint, simulation or bench': 'Enxame em um ponto de referência, simulação ou bancada',
  'One scenario for simulation and bench: a swarm is held at a setpoint by four coils.': 'Um mesmo cenário para simulação e bancada: quatro bobinas mantêm um enxame em um ponto de referência.',
  'One scenario for simulation and bench: a simulation uses the positions of all cells or rendered pictures, and a run on the bench uses the camera and coils of [rig], here a simulated bench in real time.': 'Um mesmo cenário para simulação e bancada: uma simulação usa as posições de todas as células ou imagens renderizadas, e uma execução na bancada usa a câmera e as bobinas de [rig], aqui uma bancada simulada em tempo real.',
  // compact
  'Around an obstacle': 'Ao redor de um obstáculo',
  'Two swarms': 'Dois enxames',
  'Gather and move': 'Reunir e mover',
  'Two swarms of opposite polarity between eight coils: each is steered to a setpoint of its own.': 'Dois enxames de polaridade oposta entre oito bobinas: cada um é conduzido a um ponto de referência próprio.',
  'A swarm is steered around an obstacle, with little heat in the coils.': 'Um enxame é conduzido ao redor de um obstáculo, com pouco calor nas bobinas.',
  'Cells that fill a drop are gathered at its edge, and the compact swarm is moved over half of the drop.': 'Células que preenchem uma gota são reunidas na sua borda, e o enxame compacto é movido por metade da gota.',
  // one-cell-msr1
  'One cell of MSR-1 at a setpoint': 'Uma célula de MSR-1 em um ponto de referência',
  'A rotating field holds one cell of MSR-1 at a setpoint, as in a published experiment.': 'Um campo girante mantém uma célula de MSR-1 em um ponto de referência, como em um experimento publicado.',
  'One cell of MSR-1 in a field of 2 mT, as in a published experiment (docs/results/control.md). A cell swims all the time: the smallest circle that it can stay in has the radius v / w_B, here 32 um/s / 1.48 rad/s.': 'Uma célula de MSR-1 em um campo de 2 mT, como em um experimento publicado (docs/results/control.md). Uma célula nada o tempo todo: o menor círculo em que ela pode permanecer tem o raio v / w_B, aqui 32 µm/s / 1,48 rad/s.',
  // one-cell-maze
  'One cell of MSR-1 in a maze': 'Uma célula de MSR-1 em um labirinto',
  'A linear-quadratic regulator steers one cell of MSR-1 along the corridors of a maze.': 'Um regulador linear-quadrático conduz uma célula de MSR-1 pelos corredores de um labirinto.',
  'One cell along the corridors of a maze, 10 um wide, as in a published experiment (docs/results/control.md). There are no walls: the distance from the middle of the corridor shows whether the cell would touch one, at 5 um.': 'Uma célula pelos corredores de um labirinto, com 10 µm de largura, como em um experimento publicado (docs/results/control.md). Não há paredes: a distância ao meio do corredor mostra se a célula tocaria uma, a 5 µm.',
  // one-cell-microjet
  'One microjet at a setpoint': 'Um microjato em um ponto de referência',
  'A self-propelled microjet is steered to a setpoint, as in a published experiment.': 'Um microjato autopropelido é conduzido a um ponto de referência, como em um experimento publicado.',
  'A self-propelled microjet at a setpoint, as in a published experiment (docs/results/control.md). Its speed is published; size and moment are assumed, so that it turns at 2 rad/s in a field of 2 mT.': 'Um microjato autopropelido em um ponto de referência, como em um experimento publicado (docs/results/control.md). A sua velocidade é publicada; tamanho e momento são supostos, de modo que ele gira a 2 rad/s em um campo de 2 mT.',
  // million
  'A million cells': 'Um milhão de células',
  'A million cells in a constant field, for measurements of speed.': 'Um milhão de células em um campo constante, para medidas de velocidade.',
  'A million cells for 600 frames; every tenth frame is recorded. docs/guide/speed.md gives its time and memory.': 'Um milhão de células por 600 quadros; cada décimo quadro é gravado. docs/guide/speed.md informa o tempo e a memória.',
  // as-seen
  'Step response as a camera records it': 'Resposta ao degrau como uma câmera a grava',
  'A step response recorded as a grey, blurred and noisy video of 25 degrees of the edge.': 'Uma resposta ao degrau gravada como vídeo cinza, borrado e ruidoso de 25 graus da borda.',
  'A step response as a camera records it: cells accumulate at the edge of a drop and swim away when the field is reversed after one second. The picture shows 25 degrees of the edge. The video is grey, blurred and noisy.': 'Uma resposta ao degrau como uma câmera a grava: as células se acumulam na borda de uma gota e nadam para longe quando o campo é invertido após um segundo. A imagem mostra 25 graus da borda. O vídeo é cinza, borrado e ruidoso.',
  // response
  'Four field segments': 'Quatro segmentos de campo',
  'The field is reversed every three seconds: an experiment for the identification of models.': 'O campo é invertido a cada três segundos: um experimento para a identificação de modelos.',
  'An experiment for identification (studies/step-response.toml): rendered pictures of a drop, of which an arc is in view. The field drives the swarm away from the edge after one second, and is then reversed every three seconds.': 'Um experimento para identificação (studies/step-response.toml): imagens renderizadas de uma gota, da qual se vê um arco. O campo afasta o enxame da borda após um segundo, e depois é invertido a cada três segundos.',
  // short-response
  'Four short field segments': 'Quatro segmentos curtos de campo',
  'The field is reversed every 1.5 seconds: an experiment for the calibration of an identification.': 'O campo é invertido a cada 1,5 segundo: um experimento para a calibração de uma identificação.',
  'A short experiment for the calibration of an identification (studies/short-response.toml): rendered pictures of a drop, of which an arc is in view. The field drives the swarm away from the edge after half a second, and is then reversed every 1.5 seconds.': 'Um experimento curto para a calibração de uma identificação (studies/short-response.toml): imagens renderizadas de uma gota, da qual se vê um arco. O campo afasta o enxame da borda após meio segundo, e depois é invertido a cada 1,5 segundo.',
  // exposure
  'Step response at a given air exposure time': 'Resposta ao degrau com um dado tempo de exposição ao ar',
  'After 100 s of exposure to air the cells swim slower, and fewer of them respond.': 'Após 100 s de exposição ao ar as células nadam mais devagar, e menos delas respondem.',
  'A step response at a given air exposure time: the field drives cells to the edge of a drop for 20 s and is then reversed; the cells swim through the picture. The longer the air exposure time, the slower the cells, and the fewer of them respond.': 'Uma resposta ao degrau com um dado tempo de exposição ao ar: o campo leva as células à borda de uma gota por 20 s e então é invertido; as células nadam através da imagem. Quanto mais longo o tempo de exposição ao ar, mais lentas são as células, e menos delas respondem.',
  // aging
  'Step response, air exposure time five minutes': 'Resposta ao degrau após cinco minutos de exposição ao ar',
  'After five minutes of exposure to air the cells are slower; cells near the edge stop responding first.': 'Após cinco minutos de exposição ao ar as células são mais lentas; as que estão perto da borda deixam de responder primeiro.',
  'The step response of a sample with an air exposure time of five minutes: cells are slower, and some no longer respond. Cells near the edge stop responding first.': 'A resposta ao degrau de uma amostra com um tempo de exposição ao ar de cinco minutos: as células são mais lentas, e algumas já não respondem. As células perto da borda deixam de responder primeiro.',
  // null-route
  'Swarm in a moving zero of the field': 'Enxame em um zero móvel do campo',
  'The cells gather in a zero of the field of four coils, and the zero moves along a route.': 'As células se reúnem em um zero do campo de quatro bobinas, e o zero se move por uma rota.',
  'A swarm follows a zero of the field that moves along a route. The zero is a trap in which the cells gather.': 'Um enxame segue um zero do campo que se move por uma rota. O zero é uma armadilha na qual as células se reúnem.',
  // thesis-coils-a
  'Thesis, figure 4.5a: one swarm at the left': 'Tese, figura 4.5a: um enxame à esquerda',
  'The fields of both coils point to the right, and the south-seeking swarm gathers at the left edge.': 'Os campos das duas bobinas apontam para a direita, e o enxame de células sul se reúne na borda esquerda.',
  'Figure 4.5a of the thesis by L. F. M. Diniz, 2016: the fields of both coils point to the right, and the south-seeking swarm gathers at the left edge.': 'Figura 4.5a da tese de L. F. M. Diniz, 2016: os campos das duas bobinas apontam para a direita, e o enxame de células que buscam o sul se reúne na borda esquerda.',
  // thesis-coils-b
  'Thesis, figure 4.5b: one swarm at the right': 'Tese, figura 4.5b: um enxame à direita',
  'As figure 4.5a, with reversed currents.': 'Como a figura 4.5a, com correntes invertidas.',
  'Figure 4.5b of the thesis by L. F. M. Diniz, 2016: as figure 4.5a, with reversed currents.': 'Figura 4.5b da tese de L. F. M. Diniz, 2016: como a figura 4.5a, com correntes invertidas.',
  // thesis-coils-c
  'Thesis, figure 4.5c: no swarm in the middle': 'Tese, figura 4.5c: nenhum enxame no meio',
  'Two coils with opposite fields, expected to gather a swarm in the middle; currents that differ by 10 % move it to an edge.': 'Duas bobinas com campos opostos, que deveriam reunir um enxame no meio; correntes que diferem em 10 % o levam a uma borda.',
  "Figure 4.5c of the thesis by L. F. M. Diniz, 2016: two coils with opposite fields, expected to gather a swarm in the middle. The experiment showed one swarm at an edge; here this results from currents that differ by 10 % and from the Earth's field.": 'Figura 4.5c da tese de L. F. M. Diniz, 2016: duas bobinas com campos opostos, que deveriam reunir um enxame no meio. O experimento mostrou um enxame em uma borda; aqui isso resulta de correntes que diferem em 10 % e do campo da Terra.',
  // thesis-coils-d
  'Thesis, figure 4.5d: one swarm instead of two': 'Tese, figura 4.5d: um enxame em vez de dois',
  'Two coils with opposite fields of the other sign, expected to form two swarms; one swarm forms at an edge.': 'Duas bobinas com campos opostos do outro sinal, que deveriam formar dois enxames; um enxame se forma em uma borda.',
  "Figure 4.5d of the thesis by L. F. M. Diniz, 2016: two coils with opposite fields of the other sign, expected to form two swarms. The experiment showed one swarm at an edge; here this results from currents that differ by 10 % and from the Earth's field.": 'Figura 4.5d da tese de L. F. M. Diniz, 2016: duas bobinas com campos opostos do outro sinal, que deveriam formar dois enxames. O experimento mostrou um enxame em uma borda; aqui isso resulta de correntes que diferem em 10 % e do campo da Terra.',
  // thesis-basic
  'Thesis, controller experiment, Basic model': 'Tese, experimento de controle, modelo Básico',
  'The fuzzy controller moves a swarm of the Basic model from the left wall to the centre.': 'O controlador fuzzy leva um enxame do modelo Básico da parede esquerda ao centro.',
  'The controller experiment of the thesis by L. F. M. Diniz, 2016 (its Figs. 4.18-4.20), with its Basic model: the fuzzy controller moves a swarm from the left wall to the centre. 400 iterations of one frame each.': 'O experimento de controle da tese de L. F. M. Diniz, 2016 (suas Figs. 4.18 a 4.20), com o seu modelo Básico: o controlador fuzzy leva um enxame da parede esquerda ao centro. 400 iterações de um quadro cada.',
  // thesis-adapted
  'Thesis, controller experiment, Adapted model': 'Tese, experimento de controle, modelo Adaptado',
  'The fuzzy controller moves a swarm of the Adapted model from the left wall to the centre.': 'O controlador fuzzy leva um enxame do modelo Adaptado da parede esquerda ao centro.',
  'The controller experiment of the thesis by L. F. M. Diniz, 2016 (its Figs. 4.18-4.20), with its Adapted model: the fuzzy controller moves a swarm from the left wall to the centre. 400 iterations of one frame each.': 'O experimento de controle da tese de L. F. M. Diniz, 2016 (suas Figs. 4.18 a 4.20), com o seu modelo Adaptado: o controlador fuzzy leva um enxame da parede esquerda ao centro. 400 iterações de um quadro cada.',
  // thesis-published
  'Thesis, controller experiment, as published': 'Tese, experimento de controle, como publicado',
  'The Basic model with the rules of the published program: integer positions, cells that move one after the other.': 'O modelo Básico com as regras do programa publicado: posições inteiras, células que se movem uma após a outra.',
  'thesis-basic with the rules of the published program: integer positions, cells move sequentially.': 'thesis-basic com as regras do programa publicado: posições inteiras, células que se movem uma após a outra.',
  // corner
  'Thesis, figure 4.17: swarm driven into the top-left corner': 'Tese, figura 4.17: enxame levado ao canto superior esquerdo',
  'A constant field drives a compact swarm from the centre into the top-left corner.': 'Um campo constante leva um enxame compacto do centro ao canto superior esquerdo.',
  'Fig. 4.17 of the thesis by L. F. M. Diniz, 2016: a compact swarm is driven from the centre into the top-left corner by a constant field. The cells are south-seeking, so the field points in the opposite direction: 5 field units of 23 uT along each axis. The duration of 6 s is that of the thesis; the swarm contracts further into the corner after this time.': 'Fig. 4.17 da tese de L. F. M. Diniz, 2016: um enxame compacto é levado do centro ao canto superior esquerdo por um campo constante. As células buscam o sul, por isso o campo aponta na direção oposta: 5 unidades de campo de 23 µT ao longo de cada eixo. A duração de 6 s é a da tese; depois desse tempo o enxame se contrai ainda mais no canto.',
};
